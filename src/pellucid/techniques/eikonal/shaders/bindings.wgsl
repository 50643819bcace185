// What a volume is to a shader: its parameters and its fields, all in object space (metres, box centred on 0).

//!struct VolumeParams from techniques.eikonal.layouts

// Which fields the volume has. Constants rather than parameters: a driver that runs lanes in step does not skip a branch that
// none of them takes, so the look-up of a field that is not there would cost as much as of one that is.
override ABSORBS: bool = true;
override EMITS: bool = true;
override SCATTERS: bool = true;    // anything in the volume scatters light
override SCATTER_VARIES: bool = true;   // differently from place to place, not only from region to region
override BLOCKS: bool = true;      // has opaque voxels

override REFLECTS: bool = false;   // has reflection data

override MEETS_MESHES: bool = false;   // opaque meshes reach into the box

@group(0) @binding(0) var<uniform> volume: VolumeParams;
@group(0) @binding(1) var volume_sampler: sampler;
// xyz: grad(n^2)/2 (leapfrog) or grad n (Euler), scaled; w: radius around here, in voxels, in which every field is constant.
// Of a volume in which no ray bends, x: radius in which matter is constant; w: radius free of opaque voxels
@group(0) @binding(2) var force_field: texture_3d<f32>;
// signed distance to the surface of each region, in voxels
@group(0) @binding(3) var distance_field: texture_3d<f32>;
// n - ambient_n, scaled
@group(0) @binding(4) var index_field: texture_3d<f32>;
@group(0) @binding(5) var absorption_field: texture_3d<f32>;
@group(0) @binding(6) var emission_field: texture_3d<f32>;
// linear rgb, coverage
@group(0) @binding(7) var opaque_field: texture_3d<f32>;
// rgb: scattering, 1/world m; w: its anisotropy
@group(0) @binding(14) var scattering_field: texture_3d<f32>;
// rgb: light that passes here from all sides, radiant power per area
@group(0) @binding(15) var fluence_field: texture_3d<f32>;
// xyz: mean direction of that light, object space; its length says how parallel it is, 0 to 1
@group(0) @binding(16) var light_field: texture_3d<f32>;
// linear rgb: tint of mirrored light; a: roughness
@group(0) @binding(17) var reflection_field: texture_3d<f32>;
