// One level of the means of slopes and of their products from the finer one [olano2010]; twin of wave_moments.py.

override FROM_TEXELS: bool = false;  // the finer level is that of the waves themselves: height, dh/dx, dh/dz, fold

@group(0) @binding(0) var finer_mean: texture_2d<f32>;
@group(0) @binding(1) var finer_square: texture_2d<f32>;
@group(0) @binding(2) var mean_out: texture_storage_2d<rgba32float, write>;
@group(0) @binding(3) var square_out: texture_storage_2d<rgba32float, write>;

// Of three lines from 2 at on: of an odd number of lines, n = 2 m + 1, each mean takes n / m
fn shares(at: u32, count: u32) -> vec3f {
    let half = f32(count / 2u);
    let odd = vec3f(half - f32(at), half, f32(at) + 1.0) / f32(count);
    let several = select(odd, vec3f(0.5, 0.5, 0.0), count % 2u == 0u);
    return select(several, vec3f(1.0, 0.0, 0.0), count == 1u);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(mean_out)) { return; }
    let size = textureDimensions(finer_mean);
    let across = shares(id.x, size.x);
    let down = shares(id.y, size.y);
    var mean = vec4f(0.0);
    var square = vec4f(0.0);
    for (var j = 0u; j < 3u; j++) {
        for (var i = 0u; i < 3u; i++) {
            let at = min(2u * id.xy + vec2u(i, j), size - 1u);
            let share = across[i] * down[j];
            let found = textureLoad(finer_mean, at, 0);
            let slope = found.yz;
            let own = vec4f(slope * slope, slope.x * slope.y, found.w * found.w);
            mean += share * select(found, found.yzwx, FROM_TEXELS);
            square += share * select(textureLoad(finer_square, at, 0), own, FROM_TEXELS);
        }
    }
    textureStore(mean_out, id.xy, mean);
    textureStore(square_out, id.xy, square);
}
