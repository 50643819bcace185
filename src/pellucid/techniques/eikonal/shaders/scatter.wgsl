// Light that matter scatters once into a viewing ray [tevs2007, eq. 5.5].

//!import optics/phase
//!import techniques/eikonal/shaders/matter

// Mean radiance of the surroundings; a pass that looks sets it, one that only traces leaves it 0.
var<private> ambient_radiance: vec3f;

// Radiance that a ray of direction d, against the light that it carries, gains per world metre. Light from lamps has a direction;
// g times its length is the mean cosine that is left of the scattering where light comes from many sides. That of the surroundings
// comes from all of them, as if nothing dimmed it, and n^2 as strong inside index n [born1999, 4.8.3].
fn in_scattered(x: vec3f, d: vec3f, n: f32, scattering: vec4f) -> vec3f {
    if (!SCATTERS) { return vec3f(0.0); }
    let at = texture_position(x);
    let fluence = textureSampleLevel(fluence_field, volume_sampler, at, 0.0).rgb;
    let light = textureSampleLevel(light_field, volume_sampler, at, 0.0).xyz;
    let parallel = min(length(light), 1.0);
    let cos_theta = clamp(-dot(light, d) / max(parallel, 1e-6), -1.0, 1.0);
    let dense = n / volume.ambient_n;
    return scattering.rgb * (fluence * henyey_greenstein(cos_theta, scattering.w * parallel) + ambient_radiance * (dense * dense));
}
