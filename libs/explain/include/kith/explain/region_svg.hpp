#pragma once

#include <string>
#include <vector>

#include "kith/explain/svg.hpp"
#include "kith/geometry/cone.hpp"

namespace kith {

/// A region of reward weights inside a larger one, and the robot's weights inside both.
struct RegionPicture {
  std::vector<std::string> features;  ///< Names, shape [d].
  Cone prior;                         ///< What everybody knows beforehand.
  Cone region;                        ///< Inside the prior.
  IntegerVector robot;                ///< Strictly inside the prior, inside the region.
  std::vector<std::string> captions;  ///< Of the region's facets, in the order of facets().
};

/// A drawing and how large it is.
struct SizedSvg {
  Svg svg;
  double width = 0.0, height = 0.0;
};

/// With three features: the unit sphere seen from the robot's weights, orthographically; the prior pale, the region
/// dark, its boundaries as numbered great circles with their captions beside it.
/// With any other number: for every pair of features the two weights of points that fill prior and region evenly,
/// each pair a projection of the sphere of weights of length 1.
[[nodiscard]] SizedSvg region_svg(const RegionPicture& picture);

}  // namespace kith
