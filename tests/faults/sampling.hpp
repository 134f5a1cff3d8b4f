#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fault_case.hpp"
#include "kith/core/stream.hpp"
#include "models.hpp"
#include "scenario.hpp"

namespace kith::faults {

/// Every family of faults, in the order of tables.
[[nodiscard]] const std::vector<std::string>& all_families();

/// Draws cases: of the calls that an undisturbed run makes, of the time it takes, of the files it leaves.
class Sampler {
 public:
  Sampler(const Models& models, const std::vector<Scenario>& scenarios, std::uint64_t seed,
          std::filesystem::path scratch);

  /// So many different cases of a family, over all scenarios in turn; fewer where there are no more.
  [[nodiscard]] std::vector<Case> draw(const std::string& family, std::size_t number);

 private:
  // What an undisturbed run of the struck command comes to.
  struct Run {
    std::vector<std::pair<std::string, std::uint64_t>> calls{};  // by kind
    std::int64_t microseconds = 0;
  };

  [[nodiscard]] std::optional<Case> draw_one(const Scenario& scenario, const std::string& family, RandomStream& random);
  [[nodiscard]] std::string draw_call(const Run& run, const std::string& family, RandomStream& random) const;
  [[nodiscard]] const Run& undisturbed(const Scenario& scenario, int variant);

  const Models& models_;
  const std::vector<Scenario>& scenarios_;
  std::uint64_t seed_;
  std::filesystem::path scratch_;
  std::map<std::string, Run> runs_;
};

}  // namespace kith::faults
