// Short sentences that follow from constraints with long normals, as expectations have them.
#include "kith/explain/statement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "kith/core/math.hpp"
#include "kith/geometry/cone.hpp"

namespace kith {
namespace {

constexpr std::int64_t kLargest = 1000;  // beyond that nobody compares numbers

// Whether people can keep the numbers in mind: one may be large. Beside it another up to 10, or if there are three or
// more things another up to 3, and each of the rest once.
bool is_light(const IntegerVector& normal) {
  constexpr std::int64_t kSecondOfTwo = 10, kSecondOfMore = 3;
  std::vector<std::int64_t> sizes;
  for (const auto entry : normal) {
    if (entry != 0) sizes.push_back(std::abs(entry));
  }
  std::sort(sizes.begin(), sizes.end(), std::greater<>{});
  if (sizes.size() < 2) return true;
  if (sizes.size() == 2) return sizes[1] <= kSecondOfTwo;
  return sizes[1] <= kSecondOfMore && sizes[2] == 1;
}

bool is_short(const IntegerVector& normal) {
  const bool is_round = std::all_of(normal.begin(), normal.end(), [](std::int64_t entry) {
    const auto size = std::abs(entry);
    return size <= kLargest && round_number(size, false) == size;
  });
  return is_round && is_light(normal);
}

// n / unit for n >= 0, down or up, as a round number.
std::int64_t scaled(std::int64_t n, std::int64_t unit, bool up) {
  return round_number(n / unit + (up && n % unit != 0 ? 1 : 0), up);
}

// The weights that satisfy all of them; nothing if there are none, or their rays are too long to compute with.
std::optional<Cone> region_of(std::span<const HalfSpace> known, std::span<const HalfSpace> more, std::size_t d) {
  try {
    Cone region{d};
    if (region.clip(known) && region.clip(more)) return region;
  } catch (const std::overflow_error&) {
  }
  return std::nullopt;
}

// A statement, how much weaker than the constraint it is (the share of what both sides weigh to the robot) and how much
// there is to remember.
struct Candidate {
  IntegerVector normal;
  double slack = 0.0;
  double length = 0.0;
};

// Ways to write a constraint with small numbers, the best first: close to the constraint, and little to remember.
class Candidates {
 public:
  Candidates(const Domain& domain, const IntegerVector& normal) : domain_{domain}, normal_{normal} {
    const auto d = normal.size();
    for (std::size_t anchor = 0; anchor < d; ++anchor) {
      if (normal[anchor] == 0) continue;
      const auto unit = std::abs(normal[anchor]);
      add_weaker(unit);
      if (d <= kFew) add_others(unit, anchor);
    }
    std::sort(all_.begin(), all_.end(), [](const Candidate& a, const Candidate& b) {
      return rank(a) != rank(b) ? rank(a) < rank(b) : a.normal < b.normal;
    });
  }

  [[nodiscard]] const std::vector<Candidate>& all() const { return all_; }

 private:
  static constexpr std::size_t kFew = 3;  // features for which every combination is tried

  // One more binary digit must make it stronger by this share.
  [[nodiscard]] static double rank(const Candidate& candidate) {
    constexpr double kWorth = 0.05;
    return candidate.slack + kWorth * candidate.length;
  }

  // Whoever agrees with the robot on costs and gains, and with the constraint, agrees with this: what stands on the
  // heavier side is rounded up, the rest down.
  void add_weaker(std::int64_t unit) {
    std::vector<bool> up(normal_.size());
    for (std::size_t k = 0; k < normal_.size(); ++k) {
      const bool is_cost = domain_.weights().integer[k] < 0;
      up[k] = is_cost == (normal_[k] < 0);
    }
    add(unit, up);
  }

  void add_others(std::int64_t unit, std::size_t anchor) {
    const auto d = normal_.size();
    for (std::size_t bits = 0; bits < (std::size_t{1} << d); ++bits) {
      if ((bits >> anchor & 1U) != 0) continue;  // the anchor itself is not rounded
      std::vector<bool> up(d);
      for (std::size_t k = 0; k < d; ++k) up[k] = (bits >> k & 1U) != 0;
      add(unit, up);
    }
  }

  void add(std::int64_t unit, const std::vector<bool>& up) {
    constexpr double kWeakest = 0.5;
    Candidate candidate{IntegerVector(normal_.size()), 0.0, 0.0};
    const double scale = 1.0 / static_cast<double>(unit);
    double gap = 0.0, weight = 0.0;
    for (std::size_t k = 0; k < normal_.size(); ++k) {
      if (normal_[k] == 0) continue;
      const auto size = scaled(std::abs(normal_[k]), unit, up[k]);
      if (size > kLargest) return;
      candidate.normal[k] = normal_[k] < 0 ? -size : size;
      const double own = std::abs(domain_.weights().unit[static_cast<Eigen::Index>(k)]);
      const double exact = scale * std::abs(static_cast<double>(normal_[k]));
      gap += own * std::abs(static_cast<double>(size) - exact);
      weight += own * exact;
      candidate.length += math::log(1.0 + static_cast<double>(size)) / std::numbers::ln2;
    }
    candidate.slack = weight > 0.0 ? gap / weight : 0.0;
    if (candidate.normal.is_zero() || candidate.slack > kWeakest) return;
    candidate.normal = HalfSpace{candidate.normal}.normal();
    if (is_short(candidate.normal)) all_.push_back(candidate);
  }

  const Domain& domain_;
  const IntegerVector& normal_;
  std::vector<Candidate> all_;
};

// The position of the first that holds everywhere in the region, and not everywhere in what is known without the
// constraint.
std::optional<std::size_t> first_implied(const Candidates& candidates, const std::optional<Cone>& region,
                                         const std::optional<Cone>& before) {
  if (!region) return std::nullopt;
  for (std::size_t i = 0; i < candidates.all().size(); ++i) {
    const HalfSpace said{candidates.all()[i].normal};
    if (region->implies(said) && !(before && before->implies(said))) return i;
  }
  return std::nullopt;
}

std::vector<HalfSpace> with(std::span<const HalfSpace> some, const HalfSpace& one) {
  std::vector<HalfSpace> all{some.begin(), some.end()};
  all.push_back(one);
  return all;
}

// Whether it only says that some things cost something: with a condition on one of them, that is no news.
bool is_of_costs_alone(const Domain& domain, const IntegerVector& normal) {
  for (std::size_t k = 0; k < normal.size(); ++k) {
    if (normal[k] > 0 || (normal[k] < 0 && domain.weights().integer[k] > 0)) return false;
  }
  return true;
}

// What the robot thinks of one feature: that it is a cost, or a gain.
HalfSpace sign_of_feature(const Domain& domain, std::size_t k) {
  IntegerVector normal(domain.num_features());
  normal[k] = domain.weights().integer[k] < 0 ? -1 : 1;
  return HalfSpace{normal};
}

}  // namespace

std::int64_t round_number(std::int64_t n, bool up) noexcept {
  constexpr std::int64_t kAny = 20, kHundred = 100, kStep = 5, kLargeStep = 10;
  const auto large = n > kHundred ? kLargeStep : kStep;
  const auto unit = n <= kAny ? 1 : large;
  return (n / unit + (up && n % unit != 0 ? 1 : 0)) * unit;
}

std::optional<ShortStatement> short_statement(const Domain& domain, const HalfSpace& half_space,
                                              std::span<const HalfSpace> together) {
  const auto& normal = half_space.normal();
  const bool is_counted = domain.is_exact() && std::all_of(normal.begin(), normal.end(), [](std::int64_t entry) {
                            return entry <= kLargest && entry >= -kLargest;
                          });
  if (is_counted || is_short(normal)) return ShortStatement{half_space, std::nullopt};

  const auto d = domain.num_features();
  const auto& prior = domain.prior();
  const Candidates candidates{domain, normal};
  const std::array<HalfSpace, 1> alone{half_space};
  const auto before = region_of(prior, {}, d);
  const auto statement = [&](std::size_t i, std::optional<HalfSpace> condition) {
    return ShortStatement{HalfSpace{candidates.all()[i].normal}, std::move(condition)};
  };
  if (const auto first = first_implied(candidates, region_of(prior, alone, d), before)) {
    return statement(*first, std::nullopt);
  }
  const auto all = with(together, half_space);
  if (all.size() > 1) {
    if (const auto first = first_implied(candidates, region_of(prior, all, d), before)) {
      return statement(*first, std::nullopt);
    }
  }
  std::optional<std::size_t> best;
  std::optional<HalfSpace> condition;
  for (std::size_t k = 0; k < d; ++k) {
    if (normal[k] == 0) continue;
    const auto sign = sign_of_feature(domain, k);
    if (before && before->implies(sign)) continue;
    const auto assumed = with(prior, sign);
    const auto first = first_implied(candidates, region_of(assumed, alone, d), region_of(assumed, {}, d));
    if (!first || (best && *best <= *first) || is_of_costs_alone(domain, candidates.all()[*first].normal)) continue;
    best = first;
    condition = sign;
  }
  if (!best) return std::nullopt;
  return statement(*best, condition);
}

namespace {

// Whether whoever knows one statement, and what is known beforehand, knows the other one too.
bool implies(const Domain& domain, const ShortStatement& one, const ShortStatement& other) {
  if (one.condition && one.condition != other.condition) return false;
  const auto known = other.condition ? with(domain.prior(), *other.condition)
                                     : std::vector<HalfSpace>{domain.prior().begin(), domain.prior().end()};
  const std::array<HalfSpace, 1> said{one.said};
  const auto region = region_of(known, said, domain.num_features());
  return region && region->implies(other.said);
}

// Whether two statements compare the same things, with numbers that differ by a quarter at most.
bool are_nearly_equal(const ShortStatement& one, const ShortStatement& other) {
  constexpr double kQuarter = 1.25;
  const auto& a = one.said.normal();
  const auto& b = other.said.normal();
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if ((a[k] > 0) != (b[k] > 0) || (a[k] < 0) != (b[k] < 0)) return false;
    if (a[k] == 0) continue;
    const double ratio = static_cast<double>(a[k]) / static_cast<double>(b[k]);
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  }
  return most <= kQuarter * least;
}

}  // namespace

std::vector<std::optional<ShortStatement>> short_statements(const Domain& domain,
                                                            std::span<const HalfSpace> half_spaces,
                                                            std::span<const HalfSpace> together) {
  auto all = std::vector<HalfSpace>{half_spaces.begin(), half_spaces.end()};
  all.insert(all.end(), together.begin(), together.end());
  std::vector<std::optional<ShortStatement>> statements;
  for (const auto& half_space : half_spaces) statements.push_back(short_statement(domain, half_space, all));
  if (domain.is_exact()) return statements;  // they are the constraints themselves
  for (std::size_t i = 0; i < statements.size(); ++i) {
    for (std::size_t j = 0; j < statements.size() && statements[i]; ++j) {
      if (i == j || !statements[j]) continue;
      const bool adds_a_condition = statements[i]->condition && !statements[j]->condition;
      if (adds_a_condition && are_nearly_equal(*statements[i], *statements[j])) {
        statements[i].reset();
        continue;
      }
      if (!implies(domain, *statements[j], *statements[i])) continue;
      // Of two that say the same the first stays.
      if (j < i || !implies(domain, *statements[i], *statements[j])) statements[i].reset();
    }
  }
  return statements;
}

}  // namespace kith
