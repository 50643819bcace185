// What a ray sees.

struct Seen {
    radiance: vec3f,   // where the ray ends, without what the water takes on the way
    distance_m: f32,   // way within the water; within air, to what is seen
    valid: bool,       // whether something is there, not only the environment
}
