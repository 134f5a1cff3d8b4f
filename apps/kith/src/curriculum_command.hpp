#pragma once

#include <cstdint>
#include <string>

#include "console.hpp"

namespace kith::cli {

struct CurriculumCommandOptions {
  std::string domain;
  std::string knowing;  ///< The robot before an update, which people know; empty: they know nothing.
  std::string out;      ///< Where the page goes; "-" is standard output; empty: no page.
  std::uint64_t seed = 1;
};

/// A lesson for somebody who answers every test correctly: as text, as JSON, or as a page that needs no engine.
int show_curriculum(const CurriculumCommandOptions& options, Console& console);

}  // namespace kith::cli
