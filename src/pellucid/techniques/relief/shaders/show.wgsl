// What a picture shows of a relief instead of its radiance: parts of the light, or numbers as colours.
//!import techniques/relief/shaders/glints
//!import techniques/relief/shaders/layer

override RELIEF_SHOWS: u32 = 0u;  // relief_quality.SHOWS

const RELIEF_SHOWS_RADIANCE = 0u;
const RELIEF_SHOWS_SHARES = 1u;     // red reflectance, blue what is let through [timonen2006, fig. 50]
const RELIEF_SHOWS_WAYS = 2u;       // mirrored rays: red ends on the relief, blue leaves it [timonen2006, fig. 48]
const RELIEF_SHOWS_MIRRORED = 3u;   // what mirrored rays see [timonen2006, fig. 49]
const RELIEF_SHOWS_REFRACTED = 4u;  // what refracted rays see
const RELIEF_SHOWS_LAMPS = 5u;      // lamps in the translucent layer alone [timonen2006, fig. 52]

// Whether it is colours that stand for numbers, or lamps alone: no looks are needed
fn relief_shows_at_once() -> bool {
    return RELIEF_SHOWS == RELIEF_SHOWS_SHARES || RELIEF_SHOWS == RELIEF_SHOWS_WAYS || RELIEF_SHOWS == RELIEF_SHOWS_LAMPS;
}

// Of one kind of rays alone, all light
fn relief_shown_reflectance(reflected: vec3f) -> vec3f {
    if RELIEF_SHOWS == RELIEF_SHOWS_MIRRORED {
        return vec3f(1.0);
    }
    return select(reflected, vec3f(0.0), RELIEF_SHOWS == RELIEF_SHOWS_REFRACTED);
}

fn relief_shown_at_once(frame_at: ReliefFrame, at: LayerPoint) -> vec3f {
    if RELIEF_SHOWS == RELIEF_SHOWS_LAMPS {
        return relief_glints(at.p_ws, at.n_ws, -at.direction_ws);
    }
    var red = dot(at.reflected, vec3f(1.0 / 3.0));
    if RELIEF_SHOWS == RELIEF_SHOWS_WAYS {
        let ray = relief_ray(frame_at, at.uv, at.h, reflect(at.direction_ws, at.n_ws));
        red = select(0.0, 1.0, relief_mirrored(ray).layer == RELIEF_SOLID);
    }
    return vec3f(red, 0.0, 1.0 - red);
}

// Beside them the solid layer is grey, so that none of its colours is taken for a number, and black beside lamps alone
fn relief_shown_solid(radiance: vec3f) -> vec3f {
    let grey = vec3f(dot(radiance, vec3f(0.2126, 0.7152, 0.0722)));
    let shown = select(radiance, grey, relief_shows_at_once());
    return select(shown, vec3f(0.0), RELIEF_SHOWS == RELIEF_SHOWS_LAMPS);
}
