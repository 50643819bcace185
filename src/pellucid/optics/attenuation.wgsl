// What absorption leaves of the light along a path. Twin of attenuation.py.

// exp(-sigma d) per channel [bouguer1729; timonen2006, eq. 13]
fn transmittance(sigma_per_m: vec3f, distance_m: f32) -> vec3f {
    return exp(-sigma_per_m * distance_m);
}

// a ln 2 / d0: extinction of a colour halved every d0 [timonen2006, eq. 13]
fn extinction_from_half_distance(strength: vec3f, half_distance_m: f32) -> vec3f {
    return strength * (0.69314718 / half_distance_m);
}

// C_w + exp(-k d)(C - C_w): colour seen through water [mihalik2008, eq. 4-5]
fn water_colour(colour: vec3f, deep_colour: vec3f, sigma_per_m: vec3f, distance_m: f32) -> vec3f {
    return deep_colour + transmittance(sigma_per_m, distance_m) * (colour - deep_colour);
}
