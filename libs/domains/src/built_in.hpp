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
}  // namespace kith::detail
