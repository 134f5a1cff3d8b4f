// Minimal sets against a second implementation that knows nothing of rays or
// clipping, and against facts computed by an independent program.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <utility>

#include "golden.hpp"
#include "kith/geometry/cone.hpp"
#include "random_systems.hpp"

namespace kith {
namespace {

using Row = std::array<std::int64_t, 3>;  // small entries: 64 bits are plenty

Row row_of(const HalfSpace& h) { return {h.normal()[0], h.normal()[1], h.normal()[2]}; }
std::int64_t inner(const Row& a, const Row& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Row outer(const Row& a, const Row& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
std::int64_t determinant(const Row& a, const Row& b, const Row& c) { return inner(outer(a, b), c); }
bool is_zero(const Row& a) { return a == Row{}; }

// c = s a with s >= 0; c = s a + t b with s, t >= 0; c = s a + t b + u d with
// s, t, u >= 0 (Cramer). Linearly independent factors suffice (Caratheodory).
bool spans(const Row& a, const Row& c) { return is_zero(outer(a, c)) && inner(a, c) > 0; }
bool spans(const Row& a, const Row& b, const Row& c) {
  const Row plane = outer(a, b);
  if (is_zero(plane) || inner(plane, c) != 0) return false;
  return inner(outer(c, b), plane) >= 0 && inner(outer(a, c), plane) >= 0;
}
bool spans(const Row& a, const Row& b, const Row& d, const Row& c) {
  const std::int64_t whole = determinant(a, b, d);
  if (whole == 0) return false;
  const std::int64_t s = whole > 0 ? 1 : -1;
  return s * determinant(c, b, d) >= 0 && s * determinant(a, c, d) >= 0 && s * determinant(a, b, c) >= 0;
}

// Farkas: a row is redundant iff it is a non-negative combination of the others.
bool in_cone_of(const std::vector<Row>& rows, const Row& c) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (spans(rows[i], c)) return true;
    for (std::size_t j = i + 1; j < rows.size(); ++j) {
      if (spans(rows[i], rows[j], c)) return true;
      for (std::size_t k = j + 1; k < rows.size(); ++k) {
        if (spans(rows[i], rows[j], rows[k], c)) return true;
      }
    }
  }
  return false;
}

// Gordan: no interior iff a non-trivial non-negative combination of the rows
// vanishes, that is iff the opposite of some row is a combination of all.
bool oracle_has_interior(const std::vector<Row>& rows) {
  return std::none_of(rows.begin(), rows.end(), [&](const Row& c) {
    return in_cone_of(rows, Row{-c[0], -c[1], -c[2]});
  });
}

std::set<Row> oracle_minimal_rows(std::vector<Row> rows) {
  for (std::size_t i = 0; i < rows.size();) {
    std::vector<Row> rest = rows;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    if (in_cone_of(rest, rows[i])) {
      rows = std::move(rest);
    } else {
      ++i;
    }
  }
  return {rows.begin(), rows.end()};
}

TEST(MinimalSet, AgreesWithNonNegativeCombinationsOnTenThousandSystems) {
  RandomStream random{1};
  int with_interior = 0;
  for (int i = 0; i < 10000; ++i) {
    const std::size_t n = uniform_index(9, random);
    const std::int64_t largest = 1 + static_cast<std::int64_t>(uniform_index(5, random));
    const auto system =
        i % 2 == 0 ? testing::random_system(n, largest, random) : testing::random_feasible_system(n, largest, random);
    std::vector<Row> rows;
    for (const HalfSpace& h : system) rows.push_back(row_of(h));
    const auto minimal = minimal_set(system);
    ASSERT_EQ(minimal.has_value(), oracle_has_interior(rows));
    ASSERT_EQ(minimal.has_value(), has_interior(system));
    if (!minimal) continue;
    ++with_interior;
    std::set<Row> found;
    for (const HalfSpace& h : *minimal) found.insert(row_of(h));
    ASSERT_EQ(found.size(), minimal->size());
    ASSERT_TRUE(std::is_sorted(minimal->begin(), minimal->end()));
    ASSERT_EQ(found, oracle_minimal_rows(rows));
  }
  EXPECT_GT(with_interior, 5000);
  EXPECT_LT(with_interior, 9500);
}

HalfSpace half_space_of(const nlohmann::json& row) {
  IntegerVector v(3);
  for (std::size_t k = 0; k < 3; ++k) v[k] = std::llround(row.at(k).get<double>());
  return HalfSpace{v};
}

bool is_zero_row(const nlohmann::json& row) { return row == nlohmann::json{0.0, 0.0, 0.0}; }

// The reference returns rows that were not in the input for some sets without interior.
bool is_sound(const nlohmann::json& entry) {
  if (entry.at("nonredundant_idx").is_null()) return false;
  for (const auto& index : entry.at("nonredundant_idx")) {
    if (index.is_null()) return false;
  }
  return entry.at("monte_carlo_area_4e6").get<double>() > 0.0;
}

void expect_agreement(const nlohmann::json& entry) {
  std::vector<HalfSpace> system;
  for (const auto& row : entry.at("constraints")) {
    if (!is_zero_row(row)) system.push_back(half_space_of(row));
  }
  const double estimate = entry.at("monte_carlo_area_4e6").get<double>();
  const double area = solid_angle(system);
  // The share of 4e6 uniform points is binomial; 5 standard deviations.
  const double share = area / (4.0 * std::numbers::pi);
  EXPECT_NEAR(estimate, area, 5.0 * 4.0 * std::numbers::pi * std::sqrt(share * (1.0 - share) / 4e6));
  if (!is_sound(entry)) return;

  std::set<HalfSpace> reference;
  for (const auto& row : entry.at("reference_nonredundant_rows")) reference.insert(half_space_of(row));
  const auto minimal = minimal_set(system).value();
  EXPECT_EQ(std::set<HalfSpace>(minimal.begin(), minimal.end()), reference);
  for (const auto& index : entry.at("nonredundant_idx")) {
    const HalfSpace input = half_space_of(entry.at("constraints").at(index.get<std::size_t>()));
    EXPECT_TRUE(std::binary_search(minimal.begin(), minimal.end(), input));
  }
  EXPECT_NEAR(area, entry.at("solid_angle_of_nonredundant").get<double>(), 1e-9);
}

TEST(MinimalSet, AgreesWithTheReferenceOnItsIntegerSets) {
  KITH_REQUIRE_GOLDEN(path, "minimal.json");
  std::ifstream file{*path};
  int compared = 0, sound = 0;
  for (const auto& entry : nlohmann::json::parse(file)) {
    if (entry.at("dtype") != "int64") continue;
    SCOPED_TRACE(entry.at("constraints").dump());
    expect_agreement(entry);
    ++compared;
    sound += is_sound(entry) ? 1 : 0;
  }
  EXPECT_GE(compared, 20);
  EXPECT_GE(sound, 12);
}

}  // namespace
}  // namespace kith
