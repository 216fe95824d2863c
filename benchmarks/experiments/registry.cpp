#include <array>

#include "experiments/experiment.hpp"

namespace ahm::bench {

Table applications(const Settings&);
Table backends(const Settings&);
Table boundary(const Settings&);
Table cloud_scaling(const Settings&);
Table clouds(const Settings&);
Table convergence(const Settings&);
Table costs(const Settings&);
Table cut_locus(const Settings&);
Table delaunay(const Settings&);
Table dem(const Settings&);
Table discretizations(const Settings&);
Table distance(const Settings&);
Table distortion(const Settings&);
Table exact_compared(const Settings&);
Table far(const Settings&);
Table flat(const Settings&);
Table local_maps(const Settings&);
Table march(const Settings&);
Table margins(const Settings&);
Table mazes(const Settings&);
Table direct(const Settings&);
Table mesh_scaling(const Settings&);
Table method_scaling(const Settings&);
Table methods_compared(const Settings&);
Table polygons(const Settings&);
Table radial(const Settings&);
Table runtime(const Settings&);
Table smooth_surfaces(const Settings&);
Table stages_of_a_map(const Settings&);
Table tessellations(const Settings&);
Table times(const Settings&);
Table toolpaths(const Settings&);
Table trust(const Settings&);
Table variants(const Settings&);

std::span<const Experiment> experiments() {
  static constexpr std::array list{
      Experiment{"flat", "Fig. 6", "In the plane",
                 "Both affine variants reproduce the plane; the vector heat method distorts it near the source.", flat},
      Experiment{"mazes", "Fig. 27", "Planar mazes",
                 "Where no straight line reaches, the affine heat method still reproduces planar domains.", mazes},
      Experiment{
          "distortion", "Fig. 2, 26", "Metric distortion",
          "The affine variants distort less than VHM_log, SEM and DEM, and more smoothly; near the source VHM_log "
          "and SEM distort most, DEM far from it.",
          distortion},
      Experiment{
          "distance", "Fig. 20", "Distance",
          "Near the source |phi| is more accurate than the heat method (HM) and the signed heat method (SHM); at the "
          "cut locus it is not.",
          distance},
      Experiment{"convergence", "Fig. 24", "Convergence on the sphere",
                 "Both variants converge linearly in L2 and in L-infinity; the adaptive one is slightly more accurate.",
                 convergence},
      Experiment{"smooth_surfaces", "after Fig. 24", "Convergence to smooth surfaces",
                 "Both variants converge linearly; other surfaces than the sphere are not in the paper.",
                 smooth_surfaces},
      Experiment{
          "variants", "Fig. 8", "Localized or adaptive",
          "Within the injectivity radius the localized and the adaptive variant nearly agree; they differ at the cut "
          "locus.",
          variants},
      Experiment{"cut_locus", "Fig. 12", "Colliding geodesics",
                 "Coordinates are smooth on the whole surface, also near the cut locus and across it.", cut_locus},
      Experiment{"times", "Fig. 13", "Diffusion times",
                 "AHM is accurate over orders of magnitude of the diffusion time, VHM_log is not.", times},
      Experiment{"delaunay", "Fig. 14", "Intrinsic Delaunay triangulation",
                 "It makes the quality of the map independent of the quality of the mesh.", delaunay},
      Experiment{"tessellations", "Fig. 23", "Coarse and bad triangles",
                 "AHM_l stays accurate on coarse meshes and bad triangles, where VHM_log and SEM struggle.",
                 tessellations},
      Experiment{"dem", "Fig. 25", "Discrete exponential maps",
                 "DEM is accurate near the source; its errors accumulate with distance. AHM_a stays smooth.", dem},
      Experiment{"boundary", "Fig. 4", "Boundaries", "As with SHM, the boundary does not affect distances.", boundary},
      Experiment{"radial", "Fig. 21", "Radial field on thin triangles",
                 "On anisotropic meshes affine diffusion gives a more isotropic radial field than vector diffusion.",
                 radial},
      Experiment{
          "trust", "after Fig. 20", "Polar maps and heat compared with exact maps",
          "Distances are accurate near the source and too short at cut loci; exact vectors are not in the paper.",
          trust},
      Experiment{"applications", "Fig. 18", "Decals, atlases, tool paths and means by each method",
                 "Applications by the affine heat method; the paper gives pictures, no numbers.", applications},
      Experiment{"toolpaths", "none", "Tool paths over whole parts", "Not in the paper.", toolpaths},
      Experiment{"clouds", "after Fig. 15", "Distances on clouds compared with exact ones of meshes",
                 "Point clouds work like meshes; the paper gives no distances.", clouds},
      Experiment{"exact", "none", "Exact maps, and maps by heat compared with them",
                 "On coarse meshes an exact map costs no more than the first map by heat; vectors by heat have errors "
                 "of a few percent.",
                 exact_compared},
      Experiment{"costs", "none", "Time, memory and accuracy of maps and distances", "Not in the paper.", costs},
      Experiment{
          "runtime", "Fig. 22", "Run time",
          "AHM_l is 27 % slower than VHM_log, AHM_a 70 %; additional maps are 7 to 30 (AHM_l) and 3 to 10 (AHM_a) "
          "times faster than the first.",
          runtime},
      Experiment{"discretizations", "Fig. 15, 16", "The sphere as triangles, polygons and points",
                 "The same algorithm runs on point clouds and polygon meshes; the paper gives pictures, no numbers.",
                 discretizations},
      Experiment{"polygons", "after Fig. 15", "The sphere as polygons of many kinds",
                 "The same algorithm runs on polygon meshes; the paper gives a picture, no numbers.", polygons},
      Experiment{"backends", "after Fig. 16", "Cost of each backend",
                 "The same algorithm runs on triangles, polygons and point clouds, with similar results.", backends},
      Experiment{"methods", "all", "All methods on the sphere",
                 "The paper compares with these methods, figure by figure.", methods_compared},
      Experiment{"mesh_scaling", "scaling", "Time and memory of meshes", "Not in the paper.", mesh_scaling},
      Experiment{"method_scaling", "scaling", "Time and memory of every method", "Not in the paper.", method_scaling},
      Experiment{"cloud_scaling", "scaling", "Time and memory of clouds", "Not in the paper.", cloud_scaling},
      Experiment{"direct", "scaling", "The paper's systems by LU, compared with the elimination", "Not in the paper.",
                 direct},
      Experiment{"stages", "scaling", "Time of each stage, and a lower bound", "Not in the paper.", stages_of_a_map},
      Experiment{"march", "scaling", "One map by march", "Not in the paper.", march},
      Experiment{"far", "scaling", "Flat tubes and cubes by march", "Not in the paper.", far},
      Experiment{"local_maps", "scaling", "Local maps of every vertex", "Not in the paper.", local_maps},
      Experiment{"margins", "scaling", "Margins of local maps", "Not in the paper.", margins},
  };
  return list;
}

}  // namespace ahm::bench
