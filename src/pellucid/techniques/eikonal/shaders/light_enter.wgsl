// A patch of light whose corners stand on the box of a body begins there.

//!import techniques/eikonal/shaders/light_patches

override SMOOTH: bool = false;

// `begun` says what is known of it; directions in corner_p of any length become optical momenta.
fn enter(flux: vec3f, begun: LightPatch) {
    add_flux(TOTAL_IN, flux);
    if (largest_of(flux) <= 0.0) { return; }
    var first = begun;
    let within = clamp(middle(corner_x) - light.box_center, -light.box_half, light.box_half);
    first.signs = signs_of(distances_at(light.box_center + within));
    first.region = owner_of(first.signs);
    var n = 0.0;
    if (SMOOTH) { n = index_at(middle(corner_x)); } else { n = region_index(first.region, middle(corner_x)); }
    for (var k = 0u; k < 4u; k++) { corner_p[k] = n * normalize(corner_p[k]); }
    let place = reserve(1u, 1u, light.capacity);
    if (place == NO_ROOM) { add_flux(TOTAL_ENDED, flux); return; }
    emit(place, corner_x, corner_p, flux, first);
}
