// Minimal sets and solid angles.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "cases.hpp"
#include "evidence.hpp"
#include "kith/geometry/cover.hpp"

namespace kith::bench {
namespace {

// Whether a row is a non-negative combination of three of the others, by integer determinants.
bool combines(const std::vector<IntegerVector>& rows, std::size_t target) {
  const auto sign_of = [](const IntegerVector& a, const IntegerVector& b, const IntegerVector& c) {
    return sign_of_dot(cross(a, b), c);
  };
  const IntegerVector& c = rows[target];
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = i + 1; j < rows.size(); ++j) {
      for (std::size_t k = j + 1; k < rows.size(); ++k) {
        if (i == target || j == target || k == target) continue;
        const int whole = sign_of(rows[i], rows[j], rows[k]);
        if (whole != 0 && whole * sign_of(c, rows[j], rows[k]) >= 0 && whole * sign_of(rows[i], c, rows[k]) >= 0 &&
            whole * sign_of(rows[i], rows[j], c) >= 0) {
          return true;
        }
      }
    }
  }
  return false;
}

std::vector<IntegerVector> minimal_by_combinations(const std::vector<HalfSpace>& system) {
  std::vector<IntegerVector> rows;
  for (const auto& h : system) rows.push_back(h.normal());
  for (std::size_t i = 0; i < rows.size();) {
    if (combines(rows, i)) {
      rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
  return rows;
}

Prepared minimal(std::size_t n) {
  const auto system = feasible_half_spaces(n, 40, RandomStream{1});
  Prepared prepared;
  prepared.work = [=](std::size_t rounds) {
    for (; rounds > 0; --rounds) keep(minimal_set(system));
  };
  prepared.rival = [=](std::size_t rounds) {
    for (; rounds > 0; --rounds) keep(minimal_by_combinations(system));
  };
  prepared.disagreement = [=]() -> std::string {
    auto theirs = minimal_by_combinations(system);
    std::vector<IntegerVector> ours;
    const auto minimal = minimal_set(system).value();
    for (const auto& h : minimal) ours.push_back(h.normal());
    std::sort(ours.begin(), ours.end());
    std::sort(theirs.begin(), theirs.end());
    return ours == theirs ? "" : "the minimal sets differ";
  };
  return prepared;
}

// The share of the points of a regular cover that are inside, times the sphere.
double angle_by_counting(const Cone& cone, const Eigen::Matrix3Xd& points) {
  std::size_t inside = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) inside += cone.contains(Eigen::Vector3d{points.col(i)}) ? 1u : 0u;
  return 4.0 * std::numbers::pi * static_cast<double>(inside) / static_cast<double>(points.cols());
}

Prepared solid_angle(Workbench& /*bench*/) {
  const auto cone = Cone::intersection(feasible_half_spaces(5, 40, RandomStream{1})).value();
  const Eigen::Matrix3Xd points = fibonacci_cover(Cone{}, 10'000);
  Prepared prepared;
  prepared.work = [=](std::size_t rounds) {
    for (; rounds > 0; --rounds) keep(cone.solid_angle());
  };
  prepared.rival = [=](std::size_t rounds) {
    for (; rounds > 0; --rounds) keep(angle_by_counting(cone, points));
  };
  // Points are wrong along the boundary only, within about their distance of sqrt(4 pi / 10 000) = 0.035 rad: a
  // circumference of at most 2 pi bounds the error, which mostly cancels.
  prepared.disagreement = [=]() -> std::string {
    const double ours = cone.solid_angle(), theirs = angle_by_counting(cone, points);
    if (std::abs(ours - theirs) <= 0.035) return {};
    return "solid angles of " + std::to_string(ours) + " and " + std::to_string(theirs) + " sr";
  };
  return prepared;
}

}  // namespace

void add_geometry_cases(std::vector<Case>& cases) {
  const std::string rival = "all triples of rows, by determinants";
  cases.push_back({"geometry.minimal-5", "the minimal set of 5 constraints", rival, Clock::kCpu, false,
                   [](Workbench&) { return minimal(5); }});
  cases.push_back({"geometry.minimal-20", "the minimal set of 20 constraints", rival, Clock::kCpu, false,
                   [](Workbench&) { return minimal(20); }});
  cases.push_back({"geometry.solid-angle", "the solid angle of 5 constraints", "10 000 points counted", Clock::kCpu,
                   false, solid_angle});
}

}  // namespace kith::bench
