#include "summary.hpp"

#include <fmt/format.h>

namespace kith::faults {

void Summary::Row::add(const Outcome& outcome) {
  ++cases;
  if (outcome.struck) ++struck;
  if (outcome.resumed) ++resumed;
  if (outcome.refused) ++refused;
  if (outcome.lost > 0) ++with_loss;
  lost += static_cast<std::size_t>(outcome.lost);
  if (!outcome.wrong.empty()) ++wrong;
}

void Summary::add(const Case& one, const Outcome& outcome) {
  rows_[{one.family, one.scenario}].add(outcome);
  all_.add(outcome);
}

std::string Summary::text() const {
  constexpr const char* kForm = "{:<10} {:<11} {:>6} {:>7} {:>8} {:>8} {:>10} {:>8} {:>6}\n";
  auto text = fmt::format(fmt::runtime(kForm), "family", "scenario", "cases", "struck", "resumed", "refused",
                          "with loss", "records", "WRONG");
  const auto line = [&](const std::string& family, const std::string& scenario, const Row& row) {
    text += fmt::format(fmt::runtime(kForm), family, scenario, row.cases, row.struck, row.resumed, row.refused,
                        row.with_loss, row.lost, row.wrong);
  };
  for (const auto& [name, row] : rows_) line(name.first, name.second, row);
  line("all", "", all_);
  return text;
}

}  // namespace kith::faults
