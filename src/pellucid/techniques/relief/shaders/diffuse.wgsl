// Light from everywhere through a smooth interface over a matt base; tables of surroundings/diffuse.py over exp(-absorption depth).
//!import techniques/relief/shaders/bindings

const DIFFUSE_ENTRIES = 32u;  // surroundings.layouts.DIFFUSE_ENTRIES

// Share of the light of a uniform environment that reaches the base, by channel
fn relief_diffuse_down(once: vec3f) -> vec3f {
    var out = vec3f(0.0);
    for (var channel = 0u; channel < 3u; channel++) {
        let at = saturate(once[channel]) * f32(DIFFUSE_ENTRIES - 1u);
        let k = min(u32(at), DIFFUSE_ENTRIES - 2u);
        out[channel] = mix(relief.diffuse_down[k][channel], relief.diffuse_down[k + 1u][channel], at - f32(k));
    }
    return out;
}

// Share of the light that leaves a matt base which comes back to it
fn relief_diffuse_back(once: vec3f) -> vec3f {
    var out = vec3f(0.0);
    for (var channel = 0u; channel < 3u; channel++) {
        let at = saturate(once[channel]) * f32(DIFFUSE_ENTRIES - 1u);
        let k = min(u32(at), DIFFUSE_ENTRIES - 2u);
        out[channel] = mix(relief.diffuse_back[k][channel], relief.diffuse_back[k + 1u][channel], at - f32(k));
    }
    return out;
}
