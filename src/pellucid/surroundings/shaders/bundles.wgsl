// The rays between the corners of a bundle.
//!struct OutPatch from surroundings.layouts

// The ray at a place in 0..1 across a bundle
fn bundle_point(bundle: OutPatch, st: vec2f) -> vec3f {
    return mix(mix(bundle.corner_0, bundle.corner_1, st.x), mix(bundle.corner_2, bundle.corner_3, st.x), st.y);
}

fn bundle_direction(bundle: OutPatch, st: vec2f) -> vec3f {
    return normalize(mix(mix(bundle.way_0, bundle.way_1, st.x), mix(bundle.way_2, bundle.way_3, st.x), st.y));
}

fn bundle_corner(bundle: OutPatch, corner: u32) -> vec3f {
    switch corner {
        case 0u: { return bundle.corner_0; }
        case 1u: { return bundle.corner_1; }
        case 2u: { return bundle.corner_2; }
        default: { return bundle.corner_3; }
    }
}

fn bundle_way(bundle: OutPatch, corner: u32) -> vec3f {
    switch corner {
        case 0u: { return bundle.way_0; }
        case 1u: { return bundle.way_1; }
        case 2u: { return bundle.way_2; }
        default: { return bundle.way_3; }
    }
}
