#include "kith/bec/regions.hpp"

#include "kith/geometry/cone.hpp"

namespace kith {

const Region& Regions::of(const ConstraintSet& set) {
  const auto known = known_.find(set);
  if (known != known_.end()) return known->second;
  Region region;
  if (const auto cone = Cone::intersection(table_->half_spaces(set))) {
    region.minimal = table_->set_of(cone->minimal_set());
    region.area_sr = cone->solid_angle();
  } else {
    region.minimal = set;
  }
  return known_.emplace(set, std::move(region)).first->second;
}

}  // namespace kith
