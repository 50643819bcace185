// How radiance changes where a ray crosses the surface of water.
//!import techniques/water/shaders/volume

// (n_seen / n_viewer)^-2 of what is seen [born1999, 4.8.3]; the source has no such factor [mihalik2008, eq. 9]
fn water_dilution(n_viewer: f32, n_seen: f32) -> f32 {
    let ratio = n_viewer / n_seen;
    return select(ratio * ratio, 1.0, WATER_COLOR == 1u);
}
