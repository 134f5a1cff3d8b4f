#pragma once

#include <span>

#include "kith/service/asset.hpp"

namespace kith::cli {

/// The files of the pages that `kith serve` serves, made from web/ and embedded when kith was built (web/embed.mjs);
/// none if it was built without pages.
[[nodiscard]] std::span<const Asset> web_assets();

}  // namespace kith::cli
