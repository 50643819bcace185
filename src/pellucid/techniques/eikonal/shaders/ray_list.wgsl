// Slots that hold rays, in two queues, each preceded by the arguments of the indirect dispatch that works it off: single rays
// from the beginning, lobes from the end.

const LIST_GROUP = 64u;

struct GrowingHead {
    groups_x: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    count: atomic<u32>,
}

struct GrowingList {
    heads: array<GrowingHead, 2>,
    slots: array<u32>,
}

struct FinishedHead {
    groups_x: u32,
    groups_y: u32,
    groups_z: u32,
    count: u32,
}

struct FinishedList {
    heads: array<FinishedHead, 2>,
    slots: array<u32>,
}
