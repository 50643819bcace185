// Surfaces of a sharp volume, from sampled signed distances: fast look-ups to march by, exact ones to hit by.

//!import techniques/eikonal/shaders/fields

struct Boundary {
    distance: f32,    // voxels, negative inside
    gradient: vec3f,  // per voxel edge along each axis, in voxels of distance
}

// Distances to all regions, voxels. Without regions the box itself is the surface.
fn distances_at(x: vec3f) -> vec4f {
    if (is_bare_box()) {
        return vec4f(box_distance(x), 1e9, 1e9, 1e9);
    }
    let found = textureSampleLevel(distance_field, volume_sampler, texture_position(x), 0.0);
    let unused = vec4<bool>(false, volume.region_count < 2u, volume.region_count < 3u, volume.region_count < 4u);
    return select(found, vec4f(1e9), unused);
}

// No regions: there are no distances. Asked of the texture, since the software driver builds a shader anew, at every dispatch, for the
// values of uniforms that conditions depend on alone.
fn is_bare_box() -> bool {
    return textureDimensions(distance_field).x < 2u;
}

fn box_distance(x: vec3f) -> f32 {
    let outside = abs(x) - volume.half_extent;
    return max(outside.x, max(outside.y, outside.z)) / volume.voxel;
}

fn signs_of(distances: vec4f) -> u32 {
    let bits = select(vec4u(0u), vec4u(1u, 2u, 4u, 8u), distances < vec4f(0.0));
    return bits.x | bits.y | bits.z | bits.w;
}

// The first region that contains the point owns it; outside all of them the ambient medium does (index 4).
fn owner_of(signs: u32) -> u32 {
    return min(countTrailingZeros(signs), 4u);
}

fn texel(at: vec3i, region: u32) -> f32 {
    let size = vec3i(textureDimensions(distance_field));
    return textureLoad(distance_field, clamp(at, vec3i(0), size - 1), 0)[region];
}

fn central_difference(at: vec3i, region: u32) -> vec3f {
    return 0.5 * vec3f(
        texel(at + vec3i(1, 0, 0), region) - texel(at - vec3i(1, 0, 0), region),
        texel(at + vec3i(0, 1, 0), region) - texel(at - vec3i(0, 1, 0), region),
        texel(at + vec3i(0, 0, 1), region) - texel(at - vec3i(0, 0, 1), region));
}

// Third-order interpolation: sum of w_c (s_c + g_c.(x - x_c)/2) over the eight voxels around x. Trilinear interpolation errs by
// +H h^2/8, Taylor series from the corners by as much below: the mean of the two has neither. (Derived in README.md.)
fn boundary_at(x: vec3f, region: u32) -> Boundary {
    if (is_bare_box()) { return box_surface(x); }
    let grid = texture_position(x) * vec3f(textureDimensions(distance_field)) - 0.5;
    let low = floor(grid);
    let part = grid - low;
    var distance = 0.0;
    var gradient = vec3f(0.0);
    for (var corner = 0u; corner < 8u; corner++) {
        let offset = vec3f(f32(corner & 1u), f32((corner >> 1u) & 1u), f32(corner >> 2u));
        let share = mix(1.0 - part, part, offset);
        let weight = share.x * share.y * share.z;
        let at = vec3i(low + offset);
        let slope = central_difference(at, region);
        distance += weight * (texel(at, region) + 0.5 * dot(slope, part - offset));
        gradient += weight * slope;
    }
    return Boundary(distance, gradient);
}

fn box_surface(x: vec3f) -> Boundary {
    let outside = abs(x) - volume.half_extent;
    let deepest = max(outside.x, max(outside.y, outside.z));
    let axis = select(select(vec3f(0.0, 0.0, 1.0), vec3f(0.0, 1.0, 0.0), outside.y == deepest), vec3f(1.0, 0.0, 0.0), outside.x == deepest);
    return Boundary(deepest / volume.voxel, axis * sign(x));
}

// Gradient per object metre, from the one per voxel edge.
fn per_metre(surface: Boundary) -> vec3f {
    if (is_bare_box()) { return surface.gradient / volume.voxel; }
    return surface.gradient * vec3f(textureDimensions(distance_field)) / (2.0 * volume.half_extent);
}
