// The order in which a file lists its features says nothing about the robot.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/bec/regions.hpp"
#include "kith/domains/domain_file.hpp"

namespace kith {
namespace {

using Order = std::vector<std::size_t>;  // which feature of the file stands where

const BuiltInDomain& built_in(const std::string& name) {
  const auto& all = built_in_domains();
  return *std::find_if(all.begin(), all.end(), [&](const BuiltInDomain& domain) { return domain.name == name; });
}

// A domain file in three parts: what comes before the features, each feature, and the rest.
struct FileParts {
  std::string before;
  std::vector<std::string> features;
  std::string after;
};

FileParts parts_of(std::string_view text) {
  FileParts parts;
  std::string* part = &parts.before;
  for (std::size_t at = 0; at < text.size();) {
    const auto end = std::min(text.find('\n', at), text.size() - 1) + 1;
    const auto line = text.substr(at, end - at);
    if (line.starts_with("[[feature]]")) {
      part = &parts.features.emplace_back();
    } else if (line.starts_with("[") && !parts.features.empty()) {
      part = &parts.after;
    }
    *part += line;
    at = end;
  }
  return parts;
}

Domain in_order(const BuiltInDomain& domain, const Order& order) {
  const auto parts = parts_of(domain.text);
  auto text = parts.before;
  for (const std::size_t k : order) text += parts.features[k] + "\n";
  auto reading = parse_domain(text + parts.after, std::string{domain.name}, {}, {{}, domain.files});
  for (const auto& diagnostic : reading.diagnostics) {
    EXPECT_NE(diagnostic.severity, Severity::kError) << to_text(diagnostic);
  }
  return *std::move(reading.domain);
}

// Of features that exclude each other the first that matches counts, so that their order matters.
bool means_the_same(const FileParts& parts, const Order& order) {
  std::size_t last = 0;
  for (const std::size_t k : order) {
    if (parts.features[k].find("exclusive") == std::string::npos) continue;
    if (k < last) return false;
    last = k;
  }
  return true;
}

// All orders of three features; of more, the other way round and two rotations.
std::vector<Order> other_orders(const BuiltInDomain& domain) {
  const auto parts = parts_of(domain.text);
  Order order(parts.features.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<Order> orders;
  if (order.size() <= 3) {
    while (std::next_permutation(order.begin(), order.end())) orders.push_back(order);
  } else {
    orders.emplace_back(order.rbegin(), order.rend());
    std::rotate(order.begin(), order.begin() + 1, order.end());
    orders.push_back(order);
    std::rotate(order.begin(), order.begin() + 2, order.end());
    orders.push_back(order);
  }
  std::erase_if(orders, [&](const Order& one) { return !means_the_same(parts, one); });
  return orders;
}

// What stands at place k of `normal`, which is of a file in that order, at the place that it has in the original file.
HalfSpace back(const HalfSpace& half_space, const Order& order) {
  IntegerVector normal(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) normal[order[k]] = half_space.normal()[k];
  return HalfSpace{normal};
}

std::set<HalfSpace> back(const std::vector<HalfSpace>& half_spaces, const Order& order) {
  std::set<HalfSpace> result;
  for (const auto& half_space : half_spaces) result.insert(back(half_space, order));
  return result;
}

std::set<std::size_t> back(const std::vector<std::size_t>& features, const Order& order) {
  std::set<std::size_t> result;
  for (const std::size_t k : features) result.insert(order[k]);
  return result;
}

// Exact up to three dimensions; above, estimates from different points.
void expect_same_area(double a, double error_a, double b, double error_b, const std::string& where) {
  constexpr double kStandardErrors = 6.0;
  EXPECT_NEAR(a, b, kStandardErrors * std::hypot(error_a, error_b) + 1e-9 * std::max(a, b)) << where;
}

// Up to three dimensions; above, gains of single demonstrations are measured on 4 096 points: a share p of what is left
// has a standard deviation below sqrt(p (1 - p) / 4096).
void expect_same_gain(double a, double b, std::size_t dimension, const std::string& where) {
  const double left_a = 1.0 / a, left_b = 1.0 / b;
  constexpr double kPoints = 4096.0, kDeviations = 6.0;
  const double bound = kDeviations * std::sqrt(2.0 * std::max(left_a * (1.0 - left_a), 1.0 / kPoints) / kPoints);
  EXPECT_NEAR(left_a, left_b, dimension > 3 ? bound : 1e-9) << where;
}

void expect_equivariance(const std::string& name) {
  const auto& domain = built_in(name);
  const Atlas original{load_domain(name)};
  Order straight(original.domain().num_features());
  std::iota(straight.begin(), straight.end(), std::size_t{0});
  const auto orders = other_orders(domain);
  Regions regions{original.constraints()};
  for (const auto& order : orders) {
    const Atlas permuted{in_order(domain, order)};
    std::string where = name + ", features";
    for (const std::size_t k : order) where += ' ' + std::to_string(k);

    EXPECT_EQ(back(permuted.policy_bec_half_spaces(), order), back(original.policy_bec_half_spaces(), straight))
        << where;
    expect_same_area(permuted.policy_bec_area().value, permuted.policy_bec_area().standard_error,
                     original.policy_bec_area().value, original.policy_bec_area().standard_error, where);
    EXPECT_EQ(permuted.regret_left().has_value(), original.regret_left().has_value()) << where;
    for (std::size_t k = 0; k < order.size(); ++k) {
      EXPECT_EQ(permuted.mask_counters()[k], original.mask_counters()[order[k]]) << where;
    }

    const auto& a = permuted.knowledge_components();
    const auto& b = original.knowledge_components();
    ASSERT_EQ(a.size(), b.size()) << where;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const auto what = where + ", component " + std::to_string(i);
      EXPECT_EQ(back(a[i].features, order), back(b[i].features, straight)) << what;
      EXPECT_EQ(back(a[i].masked, order), back(b[i].masked, straight)) << what;
      EXPECT_EQ(a[i].uses_mdp, b[i].uses_mdp) << what;
      EXPECT_EQ(back(permuted.constraints().half_spaces(a[i].constraints), order),
                back(original.constraints().half_spaces(b[i].constraints), straight))
          << what;
      expect_same_area(a[i].area_sr, a[i].area_error, b[i].area_sr, b[i].area_error, what);
    }

    // What a demonstration alone adds to the prior, of every so many-th.
    Regions others{permuted.constraints()};
    const auto known = regions.minimal(original.prior()), known_there = others.minimal(permuted.prior());
    ASSERT_EQ(permuted.num_states(), original.num_states()) << where;
    const auto stride = original.num_states() / 50 + 1;
    for (std::size_t i = 0; i < original.num_states(); i += stride) {
      const StartIndex start{i};
      if (!original.is_candidate(start)) continue;
      const auto shown = original.one_step(start), shown_there = permuted.one_step(start);
      ASSERT_EQ(back(permuted.constraints().half_spaces(shown_there), order),
                back(original.constraints().half_spaces(shown), straight))
          << where << ", demonstration " << i;
      expect_same_gain(others.effect(known_there, shown_there).gain, regions.effect(known, shown).gain, order.size(),
                       where);
    }
  }
}

class FeatureOrder : public ::testing::TestWithParam<std::string> {};
class FeatureOrderSlow : public ::testing::TestWithParam<std::string> {};

TEST_P(FeatureOrder, ChangesNothingButTheOrder) { expect_equivariance(GetParam()); }
TEST_P(FeatureOrderSlow, ChangesNothingButTheOrder) { expect_equivariance(GetParam()); }

std::string name_of_domain(const ::testing::TestParamInfo<std::string>& domain) {
  std::string name = domain.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(All, FeatureOrder,
                         ::testing::Values("item-delivery", "skateboard", "two-goals", "cookie-crumb", "icy-crossing"),
                         name_of_domain);
INSTANTIATE_TEST_SUITE_P(All, FeatureOrderSlow,
                         ::testing::Values("colored-tiles", "navigation", "rescue-floor", "warehouse"), name_of_domain);

TEST(FeatureOrders, AreTriedOfAllBuiltInDomains) { EXPECT_EQ(built_in_domains().size(), 9u); }

}  // namespace
}  // namespace kith
