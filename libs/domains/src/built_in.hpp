#pragma once

#include <string_view>

// Texts of the files in domains/, made by embed_text.cmake when kith is built.
namespace kith::detail {
extern const std::string_view kItemDeliveryText;
}  // namespace kith::detail
