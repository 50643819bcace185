// What a ray sees that leaves the surface, downwards within the water or upwards above it.
//!import techniques/water/shaders/seen_iteration
//!import techniques/water/shaders/seen_march
//!import techniques/water/shaders/seen_point
//!import techniques/water/shaders/seen_rays
//!import techniques/water/shaders/seen_within
//!import techniques/water/shaders/underside

override WATER_REFRACTION: u32 = 0u;  // water_quality.REFRACTIONS
override WATER_REFLECTION: u32 = 0u;  // water_quality.REFLECTIONS
override WATER_FALLBACK: u32 = 0u;    // water_quality.FALLBACKS
override WATER_SIDES_BY_RAYS: bool = false;  // borders are seen that no picture is taken for

const SEEN_BY_RAYS = 0u;

// Either side, each way of looking in one place: a software driver executes all of them for all pixels. `n` is the index
// of the water for the ray.
fn seen_along(p_ws: vec3f, direction_ws: vec3f, below: bool, from_side: bool, n: f32) -> Seen {
    if WATER_REFRACTION == 0u && WATER_REFLECTION == 0u {
        return seen_by_rays(p_ws, direction_ws, below, n);
    }
    let place = seen_place(p_ws, direction_ws, below);
    let across_others = ACROSS_WATER || ACROSS_GLASS;
    var stands = false;
    if across_others {
        let shown_m = select(WATER_FAR, place.t, place.found == PICTURE_SOMETHING);
        stands = across_stands(p_ws, direction_ws, shown_m, select(ACROSS_AIR, i32(water.region), below));
    }
    let sends_rays = stands || select(WATER_REFLECTION, WATER_REFRACTION, below) == SEEN_BY_RAYS
        || (WATER_FALLBACK == 0u && (place.found == PICTURE_UNKNOWN || place.found == PICTURE_HIDDEN))
        || (WATER_SIDES_BY_RAYS && (from_side || (below && seen_leaves(place, p_ws, direction_ws))));
    var seen = Seen(vec3f(0.0), 0.0, false);
    let by_rays = WATER_REFRACTION == SEEN_BY_RAYS || WATER_REFLECTION == SEEN_BY_RAYS;
    if across_others || WATER_FALLBACK == 0u || WATER_SIDES_BY_RAYS || by_rays {
        if sends_rays {
            seen = seen_by_rays(p_ws, direction_ws, below, n);
        }
    }
    if !sends_rays {
        seen = seen_in_picture(place, p_ws, direction_ws, below);
    }
    return seen;
}

fn seen_by_rays(p_ws: vec3f, direction_ws: vec3f, below: bool, n: f32) -> Seen {
    if WATER_OUTLINE > 0u && !ACROSS_WATER && !ACROSS_GLASS {
        return seen_within(p_ws, direction_ws, below, n);
    }
    return seen_rays(p_ws, direction_ws, below);
}

// Whether a ray comes to a border of the water's own before what a picture shows
fn seen_leaves(place: PicturePlace, p_ws: vec3f, direction_ws: vec3f) -> bool {
    if WATER_OUTLINE > 0u {
        let shown = place.found == PICTURE_SOMETHING || place.found == PICTURE_HIDDEN;
        return !shown || place.t > water_sides(p_ws, direction_ws).y;
    }
    return false;
}

// Where the ray ends in the picture of its side
fn seen_place(p_ws: vec3f, direction_ws: vec3f, below: bool) -> PicturePlace {
    let layer = select(1u, 0u, below);
    let underside = WATER_UNDERSIDE == 1u && frame.camera_position.y < p_ws.y;
    let means = select(select(WATER_REFLECTION, WATER_REFRACTION, below), 3u, underside);
    var place = PicturePlace(vec2f(0.0), WATER_FAR, PICTURE_NOTHING);
    if WATER_REFRACTION == 1u || WATER_REFLECTION == 1u {
        if means == 1u {
            place = seen_march(layer, p_ws, direction_ws);
        }
    }
    if WATER_REFRACTION == 2u {
        if means == 2u && below {
            place = seen_iteration(layer, p_ws, direction_ws);
        }
    }
    if WATER_REFLECTION == 2u || WATER_UNDERSIDE == 1u {
        if underside || (means == 2u && !below) {
            let way = select(water.point_distance_m, water.underside_distance_m, underside);
            place = seen_point(layer, p_ws, direction_ws, way);
        }
    }
    return place;
}

fn seen_in_picture(place: PicturePlace, p_ws: vec3f, direction_ws: vec3f, below: bool) -> Seen {
    let layer = select(1u, 0u, below);
    // Above, what no picture shows is the sky; below, what the border of the picture shows. What is hidden looks like
    // what hides it.
    let open = place.found == PICTURE_NOTHING || (place.found == PICTURE_UNKNOWN && !below);
    let shown = textureSampleLevel(picture_colors, view_sampler, place.uv, layer, 0.0).rgb;
    let inside = water_way(p_ws, direction_ws);
    let way = select(place.t, WATER_FAR, open);
    let denser = water.n_water / water.n_outside;
    let end = p_ws + way * direction_ws;
    let leaves = below && !(!open && water_reaches(end) && end.y < water.level + water.wave_high);
    let radiance = select(shown, environment_radiance(direction_ws), open) * select(vec3f(1.0), denser * denser, leaves);
    return Seen(radiance, select(way, min(way, inside), below), !open);
}
