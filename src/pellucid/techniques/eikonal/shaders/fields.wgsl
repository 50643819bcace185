// Look-ups in the fields of a volume. Texels are voxels, [x, y, z] = texture axes, centres at half integers.

//!import techniques/eikonal/shaders/bindings

fn texture_position(x: vec3f) -> vec3f {
    return x / (2.0 * volume.half_extent) + 0.5;
}

struct Force {
    force: vec3f,    // grad(n^2)/2, or grad n for Euler; 1/object metre
    radius: f32,     // object metres
}

fn force_at(x: vec3f) -> Force {
    let texel = textureSampleLevel(force_field, volume_sampler, texture_position(x), 0.0);
    return Force(texel.xyz * volume.force_scale, texel.w * volume.voxel);
}

fn index_at(x: vec3f) -> f32 {
    return volume.ambient_n + textureSampleLevel(index_field, volume_sampler, texture_position(x), 0.0).x * volume.index_scale;
}

// Absorption per channel, 1/world metre.
fn absorption_at(x: vec3f) -> vec3f {
    if (!ABSORBS) { return vec3f(0.0); }
    return textureSampleLevel(absorption_field, volume_sampler, texture_position(x), 0.0).xyz;
}

fn emission_at(x: vec3f) -> vec3f {
    if (!EMITS) { return vec3f(0.0); }
    return textureSampleLevel(emission_field, volume_sampler, texture_position(x), 0.0).xyz;
}

// rgb: scattering, 1/world metre; w: mean cosine of it.
fn scattering_at(x: vec3f) -> vec4f {
    if (!SCATTER_VARIES) { return vec4f(0.0); }
    return textureSampleLevel(scattering_field, volume_sampler, texture_position(x), 0.0);
}

fn opaque_at(x: vec3f) -> vec4f {
    if (!BLOCKS) { return vec4f(0.0); }
    return textureSampleLevel(opaque_field, volume_sampler, texture_position(x), 0.0);
}

// How a boundary mirrors: tint, roughness.
fn reflection_at(x: vec3f) -> vec4f {
    if (!REFLECTS) { return volume.coat; }
    return textureSampleLevel(reflection_field, volume_sampler, texture_position(x), 0.0);
}
