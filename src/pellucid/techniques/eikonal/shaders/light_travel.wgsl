// What a tube of light leaves behind on a straight piece of its way: fluence by the length of its track, and what matter takes.

//!import techniques/eikonal/shaders/light_bindings
//!import techniques/eikonal/shaders/fields

const WIDE = 1.3;         // voxels
const STRETCHED = 1.25;   // voxels that a rectangle may be wide; so much wider a patch may be where a surface has stretched it

// Rounding to whole quanta hands its remainder on, so that sums stay true.
var<private> fluence_carry: vec3f = vec3f(0.5);
var<private> direction_carry: vec4f = vec4f(0.5);

// Axes in the order (across, across, along).
fn turned(v: vec3f, axis: u32) -> vec3f {
    return select(select(v.xyz, v.zxy, axis == 1u), v.yzx, axis == 0u);
}

fn turned_whole(v: vec3u, axis: u32) -> vec3u {
    return select(select(v.xyz, v.zxy, axis == 1u), v.yzx, axis == 0u);
}

// Extinction on the way, 1/world metre: of the region, and of the fields of the box, which end where the matter does.
fn extinction_at(x: vec3f, of_region: vec3f) -> vec3f {
    let fields = absorption_at(x) + scattering_at(x).rgb;
    return of_region + select(vec3f(0.0), fields, all(abs(x) <= volume.matter_half));
}

// A tube of light on a straight piece of its way, object space.
struct Tube {
    a: vec3f,
    b: vec3f,
    edges_a: mat2x3f,     // of its cross-section, at a
    edges_b: mat2x3f,     // and at b
}

// Carries flux through a tube. Within one layer of voxels across its main axis the tube is a rectangle of known length, shared by
// the four voxels that it covers: the estimator adds flux * length / volume to the fluence, whatever the area of the tube.
fn travel(tube: Tube, flux: ptr<function, vec3f>, of_region: vec3f) {
    let a = tube.a;
    let b = tube.b;
    let size = vec3f(light.grid);
    let from_grid = (a / (2.0 * volume.half_extent) + 0.5) * size;
    let way = (b - a) / (2.0 * volume.half_extent) * size;
    let steep = abs(way);
    let axis = select(select(2u, 1u, steep.y >= steep.z), 0u, steep.x >= max(steep.y, steep.z));
    let start = turned(from_grid, axis);
    let run = turned(way, axis);
    let length_os = distance(a, b);
    if (length_os <= 0.0) { return; }
    let d = (b - a) / length_os;
    let size_a = footprint(tube.edges_a, axis, size, run);
    let size_b = footprint(tube.edges_b, axis, size, run);
    let reach = abs(run.z);
    let forward = run.z >= 0.0;
    let bounds = turned(size, axis);
    var t = 0.0;
    var waiting = vec4f(0.0);
    var cell = cell_at(a);
    // Layers are counted, not compared: rounding must not make a track stand still.
    let hop = select(-1.0, 1.0, forward);
    var border = select(ceil(start.z) - 1.0, floor(start.z) + 1.0, forward);
    for (var k = 0u; k < light.most_layers && t < 1.0; k++) {
        let until = select(clamp((border - start.z) / run.z, t, 1.0), 1.0, reach < 1e-9);
        border += hop;
        let part = until - t;
        let along = 0.5 * (t + until);
        let at = start + along * run;
        let length_m = part * length_os * volume.scale;
        let depth = extinction_at(a + along * (b - a), of_region) * length_m;
        let kept = exp(-depth);
        let mean = *flux * select((1.0 - kept) / max(depth, vec3f(1e-3)), 1.0 - 0.5 * depth, depth < vec3f(1e-3));
        *flux *= kept;
        t = until;
        // Light may begin and end outside the grid, where a box that is itself the surface has a margin.
        let within = all(at >= vec3f(0.0)) && all(at <= bounds);
        if (DEPOSITS && part > 0.0 && within) {
            let u = mix(size_a.u, size_b.u, along);
            let v = mix(size_a.v, size_b.v, along);
            let area = abs(u.x * v.y - u.y * v.x) * reach / length(run);
            var place = TubePlace(at, mix(size_a.size, size_b.size, along), area);
            if (max(dot(u, u), dot(v, v)) > WIDE * WIDE) {
                // Left wide, since it carries little: one random point of each layer stands for it.
                let across = random_pair(bitcast<vec2u>(at.xy) ^ vec2u(k)) - 0.5;
                let off = across.x * u + across.y * v;
                place = TubePlace(vec3f(clamp(at.xy + off, vec2f(0.0), bounds.xy - 1e-3), at.z), vec2f(1.0), area);
            }
            deposit(mean, length_m, place, bounds, axis);
            let weight = dot(abs(weighed(mean)), vec3f(1.0)) * (length_m * light.quanta_per_flux_m / 3.0);
            let next = cell_at(a + along * (b - a));
            if (next != cell) {
                deposit_direction(waiting, cell);
                waiting = vec4f(0.0);
                cell = next;
            }
            waiting += weight * vec4f(d, 1.0);
        }
    }
    if (DEPOSITS) { deposit_direction(waiting, cell); }
}

// Light comes from about one direction in several voxels: their mean is kept in larger cells.
fn cell_at(x: vec3f) -> u32 {
    let cells = vec3f(light.cells);
    let at = vec3u(clamp(floor((x / (2.0 * volume.half_extent) + 0.5) * cells), vec3f(0.0), cells - 1.0));
    return (at.z * light.cells.y + at.y) * light.cells.x + at.x;
}

// What a track has carried through one cell, and in which direction.
fn deposit_direction(way: vec4f, number: u32) {
    let cell = 4u * number;
    let sum = way + direction_carry;
    let whole = floor(sum);
    direction_carry = sum - whole;
    atomicAdd(&directions[cell], i32(whole.x));
    atomicAdd(&directions[cell + 1u], i32(whole.y));
    atomicAdd(&directions[cell + 2u], i32(whole.z));
    atomicAdd(&directions[cell + 3u], i32(whole.w));
}

// What a layer cuts out of a tube, in voxels: edges of the cut, and of the upright rectangle that stands for it.
struct Cut {
    u: vec2f,
    v: vec2f,
    size: vec2f,
}

// The rectangle is as wide as the cut is on average, at most STRETCHED. In a regular front rectangles of just this size leave
// neither gaps nor overlaps.
fn footprint(edges: mat2x3f, axis: u32, size: vec3f, run: vec3f) -> Cut {
    let slope = run.xy / select(run.z, 1e-9, abs(run.z) < 1e-9);
    let first = turned(edges[0] / (2.0 * volume.half_extent) * size, axis);
    let second = turned(edges[1] / (2.0 * volume.half_extent) * size, axis);
    let u = first.xy - slope * first.z;
    let v = second.xy - slope * second.z;
    return Cut(u, v, clamp(sqrt(u * u + v * v), vec2f(1e-3), vec2f(STRETCHED)));
}

// Two numbers in 0..1 [jarzynski2020, pcg2d].
fn random_pair(seed: vec2u) -> vec2f {
    var v = seed * 1664525u + 1013904223u;
    v.x += v.y * 1664525u;
    v.y += v.x * 1664525u;
    v = v ^ (v >> vec2u(16u));
    v.x += v.y * 1664525u;
    v.y += v.x * 1664525u;
    v = v ^ (v >> vec2u(16u));
    return vec2f(v >> vec2u(8u)) / 16777216.0;
}

struct TubePlace {
    at: vec3f,            // grid, axes turned
    size: vec2f,          // of the rectangle, voxels
    area: f32,            // of the tube's cross-section, voxels
}

fn deposit(carried: vec3f, length_m: f32, place: TubePlace, bounds: vec3f, axis: u32) {
    let flux = weighed(carried);
    let at = place.at;
    let size = place.size;
    let strides = turned_whole(vec3u(1u, light.grid.x, light.grid.x * light.grid.y), axis);
    let low = floor(at.xy - 0.5 * size);
    let share = 1.0 - clamp((low + 1.0 - (at.xy - 0.5 * size)) / size, vec2f(0.0), vec2f(1.0));
    let here = u32(clamp(floor(at.z), 0.0, bounds.z - 1.0)) * strides.z;
    let x = vec2u(clamp(vec2f(low.x, low.x + 1.0), vec2f(0.0), vec2f(bounds.x - 1.0))) * strides.x;
    let y = vec2u(clamp(vec2f(low.y, low.y + 1.0), vec2f(0.0), vec2f(bounds.y - 1.0))) * strides.y;
    if (INTENSITY) {
        // E = flux / area of the tube, and of several the strongest.
        let strongest = vec3i(flux * (light.intensity_quanta / max(place.area, 1e-6)));
        let voxel = 3u * (here + select(x.x, x.y, share.x >= 0.5) + select(y.x, y.y, share.y >= 0.5));
        atomicMax(&fluence[voxel], strongest.x);
        atomicMax(&fluence[voxel + 1u], strongest.y);
        atomicMax(&fluence[voxel + 2u], strongest.z);
        return;
    }
    let tracks = flux * (length_m * light.quanta_per_flux_m);
    for (var k = 0u; k < 4u; k++) {
        let weights = select(1.0 - share, share, vec2<bool>((k & 1u) != 0u, k > 1u));
        let weight = weights.x * weights.y;
        let voxel = 3u * (here + x[k & 1u] + y[k >> 1u]);
        let track = tracks * weight + fluence_carry;
        let whole = floor(track);
        fluence_carry = track - whole;
        atomicAdd(&fluence[voxel], i32(whole.x));
        atomicAdd(&fluence[voxel + 1u], i32(whole.y));
        atomicAdd(&fluence[voxel + 2u], i32(whole.z));
    }
}
