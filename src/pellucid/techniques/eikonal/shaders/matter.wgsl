// What matter does at a place: the fields of the volume and the constants of the region there, added up.

//!import techniques/eikonal/shaders/fields
//!import techniques/eikonal/shaders/walk

override CRYSTALS: bool = false;       // absorption depends on the kind of ray: a kernel of crystals sets that of its own

var<private> ray_absorption: vec3f;

// Absorption of a region, 1/world metre.
fn region_absorption_at(region: u32) -> vec3f {
    if (CRYSTALS) { return ray_absorption; }
    return volume.region_absorption[region].xyz;
}

struct Matter {
    extinction: vec3f,   // absorption + scattering, 1/world metre
    emission: vec3f,     // radiance per world metre
    scattering: vec4f,   // rgb in 1/world metre, mean cosine
}

// The owner of x; AMBIENT where no region is.
fn matter_at(x: vec3f, region: u32) -> Matter {
    let inside = region < AMBIENT;
    let owner = min(region, AMBIENT - 1u);
    let absorption = absorption_at(x) + select(vec3f(0.0), region_absorption_at(owner), inside);
    let emission = emission_at(x) + select(vec3f(0.0), volume.region_emission[owner].xyz, inside);
    let scattering = mixed(scattering_at(x), select(vec4f(0.0), volume.region_scattering[owner], inside));
    return Matter(absorption + scattering.rgb, emission, scattering);
}

// Two that scatter at one place: the mean cosine of a mixture is the mean of those of its parts.
fn mixed(a: vec4f, b: vec4f) -> vec4f {
    if (!SCATTERS) { return vec4f(0.0); }
    let share = vec2f(dot(a.rgb, vec3f(1.0)), dot(b.rgb, vec3f(1.0)));
    return vec4f(a.rgb + b.rgb, dot(share, vec2f(a.w, b.w)) / max(share.x + share.y, 1e-20));
}
