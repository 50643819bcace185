// Where rays given as arrays end in the pictures of a body of water, for tests and tables.
//!struct QueryRay from surroundings.layouts
//!struct QueryHit from surroundings.layouts
//!import techniques/water/shaders/seen_iteration
//!import techniques/water/shaders/seen_march
//!import techniques/water/shaders/seen_point

@group(1) @binding(0) var<storage, read> picture_rays: array<QueryRay>;
@group(1) @binding(1) var<storage, read_write> picture_hits: array<QueryHit>;

@compute @workgroup_size(64)
fn march(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&picture_rays) {
        let layer = picture_query_layer(id.x);
        picture_answer(id.x, layer, seen_march(layer, picture_rays[id.x].origin, picture_rays[id.x].direction));
    }
}

@compute @workgroup_size(64)
fn iteration(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&picture_rays) {
        let layer = picture_query_layer(id.x);
        picture_answer(id.x, layer, seen_iteration(layer, picture_rays[id.x].origin, picture_rays[id.x].direction));
    }
}

@compute @workgroup_size(64)
fn point(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&picture_rays) {
        let layer = picture_query_layer(id.x);
        let ray = picture_rays[id.x];
        picture_answer(id.x, layer, seen_point(layer, ray.origin, ray.direction, ray.t_max));
    }
}

// Rays that go down are looked up in the picture of what is below
fn picture_query_layer(index: u32) -> u32 {
    return select(0u, 1u, picture_rays[index].direction.y > 0.0);
}

// The place in the picture, its reversed depth there
fn picture_answer(index: u32, layer: u32, place: PicturePlace) {
    picture_hits[index].value = vec3f(place.uv, picture_depth_between(layer, place.uv));
    picture_hits[index].t = place.t;
    picture_hits[index].valid = place.found;
}
