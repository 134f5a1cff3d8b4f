#pragma once

#include "kith/domains/family_map.hpp"
#include "kith/domains/named_files.hpp"

namespace kith::detail {

// Reads [[map.raster]], and makes each known as a place that conditions can name: where its value is not 0.
void read_rasters(TomlReader& map, FamilyMap& family_map, NamedFiles& files, TomlReport& report,
                  ModelReport& model_report);

// The values of all rasters in all MDPs. Distances are steps of a robot that goes around walls; with kSeen a straight
// line between the centres of two cells must not go through a wall (Bresenham's cells between them).
void compute_rasters(FamilyMap& family_map, TomlReport& report);

}  // namespace kith::detail
