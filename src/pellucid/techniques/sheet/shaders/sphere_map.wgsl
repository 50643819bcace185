// Where a sphere map shows a unit direction of the world, from the left and from the top. Twin of scene/sphere_maps.py.

const SPHERE_MAP_TINY = 1e-12;

// The photograph of a mirror ball, taken from above [segal1999, 2.11.4]
fn sphere_map_ball(direction_ws: vec3f) -> vec2f {
    let h = direction_ws + vec3f(0.0, 1.0, 0.0);
    return direction_ws.xz / (2.0 * sqrt(max(dot(h, h), SPHERE_MAP_TINY))) + 0.5;
}

// Components from -1..1 to 0..1, by linear interpolation [oliveira2000a]
fn sphere_map_linear(direction_ws: vec3f) -> vec2f {
    return 0.5 * direction_ws.xz + 0.5;
}
