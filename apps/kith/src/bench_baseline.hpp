#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "kith/core/diagnostic.hpp"
#include "suite.hpp"

namespace kith::cli {

/// Version of the documents that `kith bench` prints, saves and compares with.
inline constexpr const char* kBenchSchema = "kith.bench/1";

/// What `kith bench --save` wrote: seconds per case, and where they are from.
struct Baseline {
  std::string processor;
  std::string build_type;
  std::string compiler;
  std::string git;
  std::map<std::string, bench::Figure> cases;
};

/// What came of reading a baseline: it, or what is wrong with the file.
struct BaselineReading {
  Baseline baseline;
  std::vector<Diagnostic> diagnostics;
};

/// @param name  of the file, for messages. Never throws for bad content.
[[nodiscard]] BaselineReading parse_baseline(std::string_view text, const std::string& name);

/// Whether a case has become slower than rounding and a restless machine explain: its median is more than `tolerance`
/// (0.1: a tenth) above the baseline's, and the quicker quarter of its samples is slower than the slower quarter of
/// the baseline's.
[[nodiscard]] bool is_slower(const bench::Figure& now, const bench::Figure& before, double tolerance);

}  // namespace kith::cli
