// Light in uniaxial crystals: two rays, where they go, and how much light each carries. Twin of crystal.py, which says
// what the letters mean. p is the momentum of a wave, `axis` the unit optic axis; p.p = n_o^2 on an ordinary ray, p.Mp = 1 on
// an extraordinary one, with M = I/n_e^2 + (1/n_o^2 - 1/n_e^2) a a^T [born1999, 15.2-15.3; kravtsov1990].

// Waves closer than this to the optic axis, rad, get a polarisation that does not depend on the last digits of p.
const CRYSTAL_CONE = 1e-4;
// Smaller normal components of p are rounding: such a wave does not arrive at the interface.
const CRYSTAL_GRAZING = 1e-6;

// Index of the extraordinary wave, 1/n^2 = cos^2/n_o^2 + sin^2/n_e^2 [born1999, 15.3.1; tevs2007, A.2]
fn extraordinary_index(cos_theta: f32, n_o: f32, n_e: f32) -> f32 {
    let square = cos_theta * cos_theta;
    return n_o * n_e / sqrt(n_e * n_e * square + n_o * n_o * (1.0 - square));
}

// Momentum of the extraordinary wave whose WAVE travels along a unit direction.
fn extraordinary_momentum(direction: vec3f, axis: vec3f, n_o: f32, n_e: f32) -> vec3f {
    return extraordinary_index(dot(direction, axis), n_o, n_e) * direction;
}

// Velocity M p of the extraordinary ray [tevs2007, A.2; kravtsov1990]; its length is 1 over the ray's index.
fn extraordinary_ray(p: vec3f, axis: vec3f, n_o: f32, n_e: f32) -> vec3f {
    let across = 1.0 / (n_e * n_e);
    return across * p + ((1.0 / (n_o * n_o) - across) * dot(axis, p)) * axis;
}

// Momentum of the extraordinary wave whose RAY goes along a unit direction: M^-1 t / sqrt(t.M^-1 t).
fn momentum_of_ray(direction: vec3f, axis: vec3f, n_o: f32, n_e: f32) -> vec3f {
    let p = n_e * n_e * direction + ((n_o * n_o - n_e * n_e) * dot(axis, direction)) * axis;
    return p / sqrt(dot(direction, p));
}

// Angle between the extraordinary wave and its ray, rad [born1999, 15.3.2]
fn walk_off(cos_theta: f32, n_o: f32, n_e: f32) -> f32 {
    let c = clamp(cos_theta, -1.0, 1.0);
    let s = sqrt(1.0 - c * c);
    let across = 1.0 / (n_e * n_e);
    let along = 1.0 / (n_o * n_o);
    return atan2(abs((along - across) * s * c), along * c * c + across * s * s);
}

// H = (p.Mp - 1)/2, 0 along every extraordinary ray [kravtsov1990]
fn crystal_hamiltonian(p: vec3f, axis: vec3f, n_o: f32, n_e: f32) -> f32 {
    return 0.5 * (dot(p, extraordinary_ray(p, axis, n_o, n_e)) - 1.0);
}

// What bends an extraordinary ray where the crystal varies: -grad(p.Mp)/2 at fixed p [kravtsov1990];
// grad_along is the gradient of a.p at fixed p, 1/m.
fn crystal_force(
    p: vec3f, axis: vec3f, n_o: f32, n_e: f32, grad_n_o: vec3f, grad_n_e: vec3f, grad_along: vec3f
) -> vec3f {
    let along = dot(axis, p);
    let across_squared = dot(p, p) - along * along;
    let turn = ((1.0 / (n_e * n_e) - 1.0 / (n_o * n_o)) * along) * grad_along;
    let stretch = (across_squared / (n_e * n_e * n_e)) * grad_n_e;
    return turn + stretch + (along * along / (n_o * n_o * n_o)) * grad_n_o;
}

// Extinction along the extraordinary RAY, 1/m: pleochroism [tevs2007, A.3, corrected: see crystal.py]
fn extraordinary_extinction(p: vec3f, axis: vec3f, n_o: f32, n_e: f32, sigma_o: vec3f, sigma_e: vec3f) -> vec3f {
    let along = dot(axis, p);
    let across_squared = max(dot(p, p) - along * along, 0.0);
    let ray = extraordinary_ray(p, axis, n_o, n_e);
    let per_ray = inverseSqrt(dot(ray, ray));
    let from_o = (per_ray * along * along / (n_o * n_o * n_o)) * sigma_o;
    return from_o + (per_ray * across_squared / (n_e * n_e * n_e)) * sigma_e;
}

// Momentum behind an interface; `decay` is its imaginary part, 0 where it is valid: a wave that travels.
struct WaveMomentum {
    p: vec3f,
    decay: vec3f,
    valid: bool,
}

// The ordinary wave behind an interface: tangential p is kept, |p| = n_o [born1999, 1.5.1].
// side: 1 where the normal points to (reflection), -1 on the other side (refraction).
fn ordinary_wave(p: vec3f, normal: vec3f, side: f32, n_o: f32) -> WaveMomentum {
    let along = dot(p, normal);
    return _behind(p - along * normal, normal, 0.0, n_o * n_o - dot(p, p) + along * along, side);
}

// The extraordinary wave: p.Mp = 1 is quadratic in the normal component of p; the sign of the root is the side of the RAY,
// whatever that of p [born1999, 15.3.3].
fn extraordinary_wave(p: vec3f, normal: vec3f, side: f32, axis: vec3f, n_o: f32, n_e: f32) -> WaveMomentum {
    let tangential = p - dot(p, normal) * normal;
    let of_normal = extraordinary_ray(normal, axis, n_o, n_e);
    let a = dot(normal, of_normal);
    let b = dot(tangential, of_normal);
    let c = dot(tangential, extraordinary_ray(tangential, axis, n_o, n_e)) - 1.0;
    return _behind(tangential, normal, -b / a, (b * b - a * c) / (a * a), side);
}

fn _behind(tangential: vec3f, normal: vec3f, middle: f32, square: f32, side: f32) -> WaveMomentum {
    let root = side * sqrt(abs(square));
    let valid = square >= 0.0;
    let along = middle + select(0.0, root, valid);
    return WaveMomentum(tangential + along * normal, select(root, 0.0, valid) * normal, valid);
}

// Field of a wave along an interface: E.u, E.v, H.u, H.v with u, v, normal right-handed.
struct TangentialField {
    real: vec4f,
    imaginary: vec4f,
}

// E along a x p, H = p x E [born1999, 15.3.2]
fn ordinary_field(p: vec3f, decay: vec3f, normal: vec3f, axis: vec3f) -> TangentialField {
    let electric = _across_axis(_Complex(p, decay), axis);
    return _tangential(electric, _cross(_Complex(p, decay), electric), normal);
}

// H along a x p, D = H x p, E = D / permittivity [born1999, 15.3.2]
fn extraordinary_field(p: vec3f, decay: vec3f, normal: vec3f, axis: vec3f, n_o: f32, n_e: f32) -> TangentialField {
    let magnetic = _across_axis(_Complex(p, decay), axis);
    let d = _cross(magnetic, _Complex(p, decay));
    let ordinary = 1.0 / (n_o * n_o);
    let more = 1.0 / (n_e * n_e) - ordinary;
    let electric = _Complex(
        ordinary * d.real + (more * dot(axis, d.real)) * axis, ordinary * d.imaginary + (more * dot(axis, d.imaginary)) * axis);
    return _tangential(electric, magnetic, normal);
}

struct _Complex {
    real: vec3f,
    imaginary: vec3f,
}

fn _cross(a: _Complex, b: _Complex) -> _Complex {
    return _Complex(
        cross(a.real, b.real) - cross(a.imaginary, b.imaginary), cross(a.real, b.imaginary) + cross(a.imaginary, b.real));
}

// Unit vector along a x p; near the axis, where that vanishes, it is led over to a fixed one.
fn _across_axis(wave: _Complex, axis: vec3f) -> _Complex {
    var h = _Complex(cross(axis, wave.real), cross(axis, wave.imaginary));
    let size = sqrt(dot(h.real, h.real) + dot(h.imaginary, h.imaginary));
    h.real += max(CRYSTAL_CONE - size, 0.0) * _perpendicular(axis);
    let per_size = inverseSqrt(dot(h.real, h.real) + dot(h.imaginary, h.imaginary));
    return _Complex(per_size * h.real, per_size * h.imaginary);
}

fn _perpendicular(v: vec3f) -> vec3f {
    return normalize(cross(v, select(vec3f(0.0, 1.0, 0.0), vec3f(1.0, 0.0, 0.0), abs(v.x) < 0.6)));
}

fn _tangential(electric: _Complex, magnetic: _Complex, normal: vec3f) -> TangentialField {
    let u = _perpendicular(normal);
    let v = cross(normal, u);
    return TangentialField(
        vec4f(dot(electric.real, u), dot(electric.real, v), dot(magnetic.real, u), dot(magnetic.real, v)),
        vec4f(dot(electric.imaginary, u), dot(electric.imaginary, v), dot(magnetic.imaginary, u), dot(magnetic.imaginary, v)));
}

// Poynting flux Re(E x H*) along the normal [born1999, 1.4.3]
fn normal_flux(real: vec4f, imaginary: vec4f) -> f32 {
    return real.x * real.w + imaginary.x * imaginary.w - real.y * real.z - imaginary.y * imaginary.z;
}

// What an interface makes of a wave: momenta, the share of the arriving flux in each, and whether each travels (1) or not (0).
struct ModeSplit {
    reflected_o: vec3f,
    reflected_e: vec3f,
    transmitted_o: vec3f,
    transmitted_e: vec3f,
    powers: vec4f,
    valid: vec4u,
}

// Tangential E and H are the same on both sides [born1999, 1.1.3]: four equations for two reflected and two transmitted waves.
// shares: (1, 0) or (0, 1) in a crystal; (1/2, 1/2) for unpolarised light in an isotropic medium, whose axis is the normal.
fn split_modes(
    p: vec3f, shares: vec2f, normal: vec3f, n_o_i: f32, n_e_i: f32, axis_i: vec3f, n_o_t: f32, n_e_t: f32, axis_t: vec3f
) -> ModeSplit {
    let back_o = ordinary_wave(p, normal, 1.0, n_o_i);
    let back_e = extraordinary_wave(p, normal, 1.0, axis_i, n_o_i, n_e_i);
    let on_o = ordinary_wave(p, normal, -1.0, n_o_t);
    let on_e = extraordinary_wave(p, normal, -1.0, axis_t, n_o_t, n_e_t);
    let fields = array<TangentialField, 4>(
        ordinary_field(back_o.p, back_o.decay, normal, axis_i),
        extraordinary_field(back_e.p, back_e.decay, normal, axis_i, n_o_i, n_e_i),
        ordinary_field(on_o.p, on_o.decay, normal, axis_t),
        extraordinary_field(on_e.p, on_e.decay, normal, axis_t, n_o_t, n_e_t));
    // What arrives is put on its surface again: near grazing incidence rounding of p would outweigh its normal component.
    let in_o = ordinary_wave(p, normal, -1.0, n_o_i);
    let in_e = extraordinary_wave(p, normal, -1.0, axis_i, n_o_i, n_e_i);
    let from_o = _powers(ordinary_field(in_o.p, vec3f(0.0), normal, axis_i), fields, vec4f(1.0, 0.0, 0.0, 0.0));
    let from_e = _powers(
        extraordinary_field(in_e.p, vec3f(0.0), normal, axis_i, n_o_i, n_e_i), fields, vec4f(0.0, 1.0, 0.0, 0.0));
    let valid = vec4<bool>(back_o.valid, back_e.valid, on_o.valid, on_e.valid);
    let powers = select(vec4f(0.0), shares.x * from_o + shares.y * from_e, valid);
    return ModeSplit(back_o.p, back_e.p, on_o.p, on_e.p, powers, select(vec4u(0u), vec4u(1u), valid));
}

// Flux of each wave over that which arrives: r_1 c_1 + r_2 c_2 + b = t_1 c_3 + t_2 c_4, by Cramer's rule. What passes along the
// interface goes on as it is.
fn _powers(b: TangentialField, c: array<TangentialField, 4>, itself: vec4f) -> vec4f {
    let back = _wedge(c[0], c[1]);
    let on = _wedge(c[2], c[3]);
    let amplitudes = vec4f(
        _meet(_wedge(b, c[1]), on), _meet(_wedge(c[0], b), on), _meet(back, _wedge(b, c[3])), _meet(back, _wedge(c[2], b)));
    let fluxes = abs(vec4f(
        normal_flux(c[0].real, c[0].imaginary), normal_flux(c[1].real, c[1].imaginary),
        normal_flux(c[2].real, c[2].imaginary), normal_flux(c[3].real, c[3].imaginary)));
    let arrives = abs(normal_flux(b.real, b.imaginary));
    let passes_by = arrives < CRYSTAL_GRAZING;
    return select(amplitudes * fluxes / (_meet(back, on) * select(arrives, 1.0, passes_by)), itself, passes_by);
}

// The six 2 x 2 minors of two columns of four.
struct _Wedge {
    first: _Complex,
    second: _Complex,
}

fn _wedge(u: TangentialField, v: TangentialField) -> _Wedge {
    let first = _Complex(
        u.real.x * v.real.yzw - u.imaginary.x * v.imaginary.yzw - v.real.x * u.real.yzw + v.imaginary.x * u.imaginary.yzw,
        u.real.x * v.imaginary.yzw + u.imaginary.x * v.real.yzw - v.real.x * u.imaginary.yzw - v.imaginary.x * u.real.yzw);
    return _Wedge(first, _cross(_Complex(u.real.yzw, u.imaginary.yzw), _Complex(v.real.yzw, v.imaginary.yzw)));
}

// |determinant|^2 of four columns, from the minors of the first two and the last two (Laplace).
fn _meet(a: _Wedge, b: _Wedge) -> f32 {
    let real = dot(a.first.real, b.second.real) - dot(a.first.imaginary, b.second.imaginary)
        + dot(a.second.real, b.first.real) - dot(a.second.imaginary, b.first.imaginary);
    let imaginary = dot(a.first.real, b.second.imaginary) + dot(a.first.imaginary, b.second.real)
        + dot(a.second.real, b.first.imaginary) + dot(a.second.imaginary, b.first.real);
    return real * real + imaginary * imaginary;
}
