#include "built_in.hpp"

#include "kith/domains/domain_file.hpp"

namespace kith {

const std::vector<BuiltInDomain>& built_in_domains() {
  static const std::vector<BuiltInDomain> kDomains{
      {"item-delivery", "a robot brings a parcel home past rubble and a charger (64 worlds)",
       detail::kItemDeliveryText},
      {"colored-tiles", "a robot crosses a room with costly tiles of two colours (512 worlds)",
       detail::kColoredTilesText},
      {"skateboard", "a robot fetches a skateboard, takes the path or walks (8 worlds)", detail::kSkateboardText},
      {"two-goals", "a robot chooses between two goals of different worth (64 worlds)", detail::kTwoGoalsText},
      {"cookie-crumb", "a robot eats crumbs on the way to a jar, or leaves (64 worlds)", detail::kCookieCrumbText},
      {"navigation", "a robot goes across gravel and grass, by road, board or car (64 worlds, seven features)",
       detail::kNavigationText},
      {"rescue-floor", "a robot makes two deliveries on a damaged floor (16 worlds of 24 x 16 cells, five features)",
       detail::kRescueFloorText},
      {"icy-crossing",
       "a robot crosses slippery ice or walks around it (3 worlds given state by state, stochastic)",
       detail::kIcyCrossingText,
       {{"icy_crossing_states.csv", std::string{detail::kIcyCrossingStates}},
        {"icy_crossing_transitions.csv", std::string{detail::kIcyCrossingTransitions}}}},
      {"warehouse",
       "a robot brings a crate past people, forklifts and cameras (7 worlds of 60 x 40 cells, six features)",
       detail::kWarehouseText,
       {{"warehouse.yaml", std::string{detail::kWarehouseGrid}},
        {"warehouse.pgm", std::string{detail::kWarehouseFloor}},
        {"warehouse_zones.pgm", std::string{detail::kWarehouseZones}}}},
  };
  return kDomains;
}

}  // namespace kith
