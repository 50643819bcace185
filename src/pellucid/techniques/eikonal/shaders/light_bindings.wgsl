// What the kernels of the light simulator share: the lists of patches, and what they are counted by.

//!import techniques/eikonal/shaders/bindings
//!struct LightParams from techniques.eikonal.layouts
//!struct LightPatch from techniques.eikonal.layouts
//!struct Generation from techniques.eikonal.layouts
//!struct OutPatch from surroundings.layouts

override DEPOSITS: bool = true;        // fluence is wanted, not only what leaves
override OUTGOING: bool = true;        // what leaves is wanted
override HANDS_ON: bool = false;       // there are other bodies, which get what leaves this one
override INTENSITY: bool = false;      // the intensity law, the strongest patch of a voxel alone [tevs2007, eq. 4.16, 6.2.3]
override AMBIENT_MATTER: bool = false; // matter without a surface dims light from the box on

const LIST_GROUP = 64u;
const TOTAL_IN = 0u;
const TOTAL_ABSORBED = 3u;
const TOTAL_OUT = 6u;
const TOTAL_ENDED = 9u;
const TOTAL_LENT = 12u;          // more than was there, against what ended by chance
const TOTAL_UNSENT = 15u;        // left, but there was no room to tell the surroundings
const TOTAL_PATCHES = 18u;

// A list of patches: the workgroups that it fills, and how long it is.
struct PatchCount {
    groups_x: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    count: atomic<u32>,
}

// The first list is what leaves the volume; list g + 1 is generation g.
struct Counters {
    lists: array<PatchCount, 65>,       // light.GENERATIONS + 1
    totals: array<atomic<u32>, 40>,     // light.TOTAL_WORDS: pairs of a low and a high word
}

@group(0) @binding(20) var<uniform> light: LightParams;
@group(0) @binding(21) var<uniform> generation: Generation;
@group(0) @binding(22) var<storage, read> patches: array<LightPatch>;
@group(0) @binding(23) var<storage, read_write> next_patches: array<LightPatch>;
@group(0) @binding(24) var<storage, read_write> counters: Counters;
// Fixed-point numbers, of which sums do not depend on the order: rgb of fluence; xyz of its direction, and their weight
@group(0) @binding(25) var<storage, read_write> fluence: array<atomic<i32>>;
@group(0) @binding(26) var<storage, read_write> directions: array<atomic<i32>>;
@group(0) @binding(27) var<storage, read_write> outgoing: array<OutPatch>;

const NO_ROOM = 0xffffffffu;

// Room for `wanted` more in a list, or NO_ROOM. The count never passes what is written.
fn reserve(list: u32, wanted: u32, capacity: u32) -> u32 {
    var place = NO_ROOM;
    var before = atomicLoad(&counters.lists[list].count);
    while (place == NO_ROOM && before + wanted <= capacity) {
        let tried = atomicCompareExchangeWeak(&counters.lists[list].count, before, before + wanted);
        place = select(NO_ROOM, before, tried.exchanged);
        before = tried.old_value;
    }
    if (place != NO_ROOM) { atomicMax(&counters.lists[list].groups_x, (place + wanted - 1u) / LIST_GROUP + 1u); }
    return place;
}

// Add to a total; a second word counts how often the first has run over.
fn add_quanta(total: u32, value: u32) {
    let before = atomicAdd(&counters.totals[2u * total], value);
    if (before > 0xffffffffu - value) { atomicAdd(&counters.totals[2u * total + 1u], 1u); }
}

// The same for a number that may be negative: the two words are a 64-bit integer.
fn add_signed(total: u32, value: i32) {
    if (value == 0) { return; }
    add_quanta(total, u32(value));
    if (value < 0) { atomicAdd(&counters.totals[2u * total + 1u], 0xffffffffu); }
}

// What flux is worth at the wavelength that is followed. Colours of single wavelengths have negative components.
fn weighed(flux: vec3f) -> vec3f {
    return light.weights * flux;
}

fn add_flux(total: u32, flux: vec3f) {
    let quanta = vec3i(floor(weighed(flux) * light.total_quanta + 0.5));
    add_signed(total, quanta.x);
    add_signed(total + 1u, quanta.y);
    add_signed(total + 2u, quanta.z);
}
