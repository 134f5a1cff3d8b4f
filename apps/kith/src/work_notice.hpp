#pragma once

#include <string>
#include <thread>

#include "console.hpp"
#include "kith/bec/atlas.hpp"

namespace kith::cli {

/// Tells people at a terminal what takes so long: a line on standard error if the work is not over after two seconds.
/// For work that cannot say how far it is; what can has Progress.
class WorkNotice {
 public:
  /// @param what  the work, as the subject of a sentence: "planning large.toml".
  WorkNotice(const Console& console, std::string what);

 private:
  std::jthread waiter_;  // none where nobody would read it; stopped and joined at the end
};

/// Plans the domain, which can take long. @throws kith::Error (kInfeasible) if there is nothing to teach.
[[nodiscard]] Atlas planned(const Domain& domain, const Console& console);

}  // namespace kith::cli
