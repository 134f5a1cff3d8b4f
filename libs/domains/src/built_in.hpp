#pragma once

#include <string_view>

// Texts of the files in domains/, embedded when kith is built (kith_embed_text).
namespace kith::detail {
extern const std::string_view kItemDeliveryText;
extern const std::string_view kColoredTilesText;
extern const std::string_view kSkateboardText;
extern const std::string_view kTwoGoalsText;
extern const std::string_view kCookieCrumbText;
extern const std::string_view kNavigationText;
extern const std::string_view kRescueFloorText;
extern const std::string_view kIcyCrossingText;
extern const std::string_view kIcyCrossingStates;
extern const std::string_view kIcyCrossingTransitions;
extern const std::string_view kWarehouseText;
extern const std::string_view kWarehouseGrid;
extern const std::string_view kWarehouseFloor;
extern const std::string_view kWarehouseZones;
}  // namespace kith::detail
