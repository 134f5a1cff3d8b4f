#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "kith/domains/domain_file.hpp"

namespace kith::testing {

/// A model without a picture.
inline Domain undrawn_cliff() {
  const auto folder = std::filesystem::path{KITH_SOURCE_DIR} / "docs/examples";
  std::ifstream file{folder / "cliff.toml"};
  std::string text;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("[model.drawing]") && !line.starts_with("columns")) text += line + '\n';
  }
  return parse_domain(text, "cliff.toml", {}, {.folder = folder}).domain.value();
}

}  // namespace kith::testing
