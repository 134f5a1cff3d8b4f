#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "kith/core/distributions.hpp"

// How often each documented analysis finds an effect that is not there: 1000 simulated studies without effects, tests
// at 5 %. The standard error of a rate of 5 % is 0.7 %. README.md has the rates; error_rates.mjs writes them there
// from the property "rates" of the tests.
namespace kith::testing {

inline constexpr std::size_t kStudies = 1'000;
inline constexpr double kAlpha = 0.05;

// Rates by the name of the analysis, in the order in which they first occur.
class Rates {
 public:
  // `p` of one study. @param exception  why the rate may be outside 3 to 7 %; empty: it may not.
  void add(const std::string& name, const std::optional<double>& p, const std::string& exception = "") {
    auto found = std::find_if(rates_.begin(), rates_.end(), [&](const Rate& rate) { return rate.name == name; });
    if (found == rates_.end()) {
      rates_.push_back({name, exception});
      found = std::prev(rates_.end());
    }
    if (!p) return;
    ++found->studies;
    found->rejected += *p < kAlpha ? 1u : 0u;
  }
  // Every rate within 3 to 7 %, but for those with a reason.
  void expect_nominal() const {
    std::string text;
    for (const auto& rate : rates_) {
      const double share = static_cast<double>(rate.rejected) / static_cast<double>(rate.studies);
      EXPECT_GE(rate.studies, kStudies * 99 / 100) << rate.name;
      if (rate.exception.empty()) {
        EXPECT_LE(share, 0.07) << rate.name;
        EXPECT_GE(share, 0.03) << rate.name;
      }
      text += fmt::format("{}|{:.1f}|{}\n", rate.name, 100.0 * share, rate.exception);
    }
    ::testing::Test::RecordProperty("rates", text);
  }

 private:
  struct Rate {
    std::string name, exception;
    std::size_t studies = 0, rejected = 0;
  };
  std::vector<Rate> rates_;
};

// A p-value of the first table whose caption begins with `caption`: of the row that is named `row`, or the smallest if
// `row` is empty.
inline std::optional<double> p_of(const Finding& finding, const std::string& caption, const std::string& row,
                                  const std::string& column = "p-value") {
  for (const auto& table : finding.tables) {
    if (table.caption.rfind(caption, 0) != 0) continue;
    std::optional<double> least;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      if (table.columns[c].name != column) continue;
      for (const auto& cells : table.rows) {
        const auto* const p = std::get_if<double>(&cells[c]);
        if (p == nullptr || (!row.empty() && std::get<std::string>(cells.front()) != row)) continue;
        least = least ? std::min(*least, *p) : *p;
      }
    }
    return least;
  }
  return std::nullopt;
}

inline std::size_t binomial(std::size_t trials, double share, RandomStream& random) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < trials; ++i) n += uniform01(random) < share ? 1u : 0u;
  return n;
}

}  // namespace kith::testing
