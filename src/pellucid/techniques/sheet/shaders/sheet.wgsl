// What a sheet shows: the picture below it, what it mirrors, or how far an approximation errs.
//!import surroundings/shaders/across
//!import techniques/sheet/shaders/false_colour
//!import techniques/sheet/shaders/picture
//!import techniques/sheet/shaders/vertex

override SHEET_SHOW: u32 = 0u;           // index into scene.refractive_sheet.SHOWS
override SHEET_SPHERE_MAP: bool = false; // the surroundings are a sphere map
override SHEET_MEETS_BELOW: bool = false;   // rays to the picture may meet meshes
override SHEET_MEETS_OUTSIDE: bool = false; // and rays to the surroundings
override SHEET_MEETS_ACROSS: bool = false;  // these may meet what stands for water and glass

@fragment
fn fs_main(in: SheetVarying, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let direction = sheet_view(in.p_os);
    let n = normalize(in.n_os);
    var look: SheetLook;
    if SHEET_PER_VERTEX {
        let hit = SheetHit(in.seen_xz, in.share_way.y);
        look = SheetLook(hit, vec3f(0.0, -1.0, 0.0), normalize(in.outward), in.share_way.x, in.share_way.y);
    } else {
        look = sheet_look(in.p_os, n, direction, !front, SHEET_EXACT);
    }
    var uv = sheet_uv(look.hit.xz, sheet.limits_low, sheet.limits_size);
    var sphere_uv = vec2f(0.0);
    if SHEET_SPHERE_MAP {
        sphere_uv = sheet_sphere_uv(look.outward);
    }
    if SHEET_PER_VERTEX {
        uv = in.seen_uv;
        sphere_uv = in.sphere_uv;
    }
    // Derivatives belong here, where all pixels come by
    let lod = sheet_lod(look.hit.xz / sheet.limits_size, vec2f(textureDimensions(sheet_picture)));
    if SHEET_SHOW == 0u {
        return vec4f(sheet_seen(in.p_os, look, uv, lod, sphere_uv, front), 1.0);
    }
    if SHEET_SHOW == 4u {
        return vec4f(uv, look.share, 1.0);
    }
    let off = look.hit.xz - sheet_look(in.p_os, n, direction, !front, true).hit.xz;
    return vec4f(sheet_error(off), 1.0);
}

// Level of the picture whose texels are as large as the pixel, the mean over both directions
fn sheet_lod(place: vec2f, texels: vec2f) -> f32 {
    let across = length(dpdx(place) * texels) * length(dpdy(place) * texels);
    return 0.5 * log2(max(across, 1.0));
}

fn sheet_error(off: vec2f) -> vec3f {
    if SHEET_SHOW == 3u {
        return sheet.scale * vec3f(length(off), off);
    }
    let seen = select(sheet.scale * length(off), length(off / sheet.extents_size), SHEET_SHOW == 2u);
    return sheet_false_colour(seen / sheet.error_scale);
}

// Radiance along both rays. Seen from within the medium it is n^2 times larger [born1999, 4.8.3].
fn sheet_seen(p: vec3f, look: SheetLook, uv: vec2f, lod: f32, sphere_uv: vec2f, front: bool) -> vec3f {
    let p_ws = (sheet.world_from_object * vec4f(p, 1.0)).xyz;
    let n = sheet.n_inside / sheet.n_outside;
    var radiance = vec3f(0.0);
    for (var k = 0u; k < 2u; k++) {
        let outside = k == 1u;
        let weight = select(look.share, 1.0 - look.share, outside);
        if weight > 0.0 {
            radiance += weight * sheet_along(p_ws, look, uv, lod, sphere_uv, outside);
        }
    }
    return select(n * n, 1.0, front) * radiance;
}

fn sheet_along(p_ws: vec3f, look: SheetLook, uv: vec2f, lod: f32, sphere_uv: vec2f, outside: bool) -> vec3f {
    var way_m = sheet.scale * look.way;
    let direction_ws = sheet_to_world(select(look.inward, look.outward, outside));
    var radiance = vec3f(0.0);
    var met = false;
    if SHEET_MEETS_ACROSS && (ACROSS_WATER || ACROSS_GLASS) {
        if outside {
            radiance = across_viewed(p_ws, direction_ws).radiance;
            met = true;
        }
    }
    if SHEET_MEETS_BELOW || SHEET_MEETS_OUTSIDE {
        let meets = select(SHEET_MEETS_BELOW, SHEET_MEETS_OUTSIDE, outside) && !met;
        let hit = trace_opaque(p_ws, direction_ws, select(0.0, select(sheet.scale * look.hit.path, 1e30, outside), meets));
        met = met || hit.valid;
        if hit.valid {
            radiance = shade_hit(hit, direction_ws);
            way_m = hit.t;
        }
    }
    if !met && outside {
        if SHEET_SPHERE_MAP {
            radiance = textureSampleLevel(sheet_sphere_map, sheet_sampler, sphere_uv, 0.0).rgb;
        } else {
            radiance = environment_radiance(direction_ws);
        }
    }
    if !met && !outside {
        radiance = sheet_picture_radiance(uv, lod, look.hit.xz);
    }
    return radiance * select(exp(-sheet.absorption * way_m), vec3f(1.0), outside);
}
