/** A row of the input, the nearest point to a position, or a point of a face (one weight per corner, sum 1). */
export type Place = number | {position: ArrayLike<number>} | {face: number; weights: ArrayLike<number>};
/** Numbers one after another, or an array of short arrays. */
export type Rows = ArrayLike<number> | ArrayLike<ArrayLike<number>>;

/** Base of all errors of the library. Messages say what is wrong, where, and what to do. */
export class AhmError extends Error {}
/** An argument is outside its range. */
export class InvalidArgument extends AhmError {}
/** The mesh or cloud is not a surface. */
export class InvalidGeometry extends AhmError {}
export class InvalidGraph extends AhmError {}
/** The matrix of a heat map cannot be factored. */
export class NotPositiveDefinite extends AhmError {}
/** The memory of WebAssembly (4 GiB) is used up. */
export class ResourceExhausted extends AhmError {}

/** Names of the numbers in `LogMap.status`: "ok", "disconnected", "beyond_radius", "unreached", "removed". */
export const statusNames: readonly string[];

/** One entry per row of the input; NaN where the status is not 0 (ok). */
export interface LogMap {
  /** Coordinates in the tangent plane of the source, world units. */
  u: Float64Array;
  v: Float64Array;
  /** Geodesic distance, world units. */
  distance: Float64Array;
  /** atan2(v, u), in (-pi, pi]. */
  angle: Float64Array;
  /** Disagreement of the paths that reach the row, world units: large near the cut locus. */
  spread: Float64Array;
  /** Expected error of the coordinates, world units; only of polar maps. */
  errorEstimate?: Float64Array;
  /** Index in `statusNames`. */
  status: Uint8Array;
  /** In (0, 1]; do not use vectors below 0.5. Only if requested. */
  quality?: Float64Array;
}

export interface Path {
  /** x y z of its points, one after another. */
  points: Float64Array;
  /** World units. */
  length: number;
  /** False for a trace that ended at the boundary. */
  complete: boolean;
  /** "ok" or "disconnected". */
  status: string;
}

/** The log maps of many sources within a radius. Source s has the entries begin[s] to begin[s + 1] - 1, nearest first. */
export interface LocalMaps {
  /** Number of sources + 1. */
  begin: Int32Array;
  /** Row of each entry. The row of a source is its own first entry. */
  row: Int32Array;
  /** Coordinates in the tangent plane of the source, world units. */
  u: Float64Array;
  v: Float64Array;
  /** Geodesic distance, world units. */
  distance: Float64Array;
  /** Area of the row, for integrals, world units squared. */
  weight: Float64Array;
  /** Parallel transport from the frame of the source to the frame of the row: a rotation. */
  cos: Float64Array;
  sin: Float64Array;
}

/** A surface in the memory of the module. Freed by `free`, or some time after it became unreachable. */
export class Surface {
  private constructor();
  /** Number of rows of the input. */
  readonly rows: number;
  /** What may be wrong with the input, or was changed. The ids are those of the C++ and Python libraries. */
  readonly warnings: {id: string; text: string}[];
  free(): void;
}

export type Method = 'automatic' | 'polar' | 'heat' | 'exact';

/** Computes maps, distances and paths on one surface. Keeps the surface alive. */
export class Solver {
  private constructor();
  /** The method in use: "polar", "heat" or "exact". */
  readonly method: string;
  /**
   * The log map of a source.
   * @param options.radius   rows farther than this get the status "beyond_radius"; world units
   * @param options.uAxis    a vector of space along which u runs, projected to the surface
   * @param options.quality  also compute `quality`
   */
  logMap(source: Place, options?: {radius?: number; uAxis?: ArrayLike<number>; quality?: boolean}): LogMap;
  /** Distance of each row from the nearest source, world units; NaN where there is none. */
  distance(sources: Place | Place[], options?: {radius?: number}): Float64Array;
  /** The shortest path; on clouds over tangent planes. */
  path(start: Place, end: Place): Path;
  /** The straightest geodesic along a vector of space. */
  trace(start: Place, direction: ArrayLike<number>, length: number): Path;
  /**
   * The log maps of all rows, or of some sources, within a radius. Not by the method exact.
   * @param options.radius   world units; may be left out if k is given
   * @param options.k        keep only this many nearest rows, the source included
   * @param options.sources  default: source s is row s; rows without a vertex have no entries
   */
  localMaps(options: {radius?: number; k?: number; sources?: Place[]}): LocalMaps;
  free(): void;
}

export interface MeshOptions {
  /** "error" (default): refuse edges with three faces and more; "split": cut the mesh there. */
  nonManifold?: 'error' | 'split';
  /**
   * Merge vertices at most this far apart, world units; 0: at equal positions, as glTF has them at seams. Default: none.
   * Maps still have one entry per vertex of the input.
   */
  weld?: number | null;
}

export class Library {
  private constructor();
  readonly version: string;
  triangleMesh(positions: Rows, triangles: Rows, options?: MeshOptions): Surface;
  polygonMesh(positions: Rows, faces: ArrayLike<number>[], options?: MeshOptions): Surface;
  /** @param options.normals  one per point, of any length; estimated if missing */
  pointCloud(positions: Rows, options?: {normals?: Rows}): Surface;
  solver(surface: Surface, options?: {method?: Method}): Solver;
}

/** Loads the module. @param source  default: libahm.wasm beside this file */
export function load(source?: string | URL | ArrayBuffer | ArrayBufferView | WebAssembly.Module): Promise<Library>;
