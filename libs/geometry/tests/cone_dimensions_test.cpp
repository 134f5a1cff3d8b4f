// Cones in two to eight dimensions: minimal sets and generators against linear
// programs, and the laws that hold in every dimension.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "kith/geometry/cone.hpp"
#include "linear_program.hpp"
#include "random_systems.hpp"

namespace kith {
namespace {

std::vector<IntegerVector> normals_of(const std::vector<HalfSpace>& system) {
  std::vector<IntegerVector> normals;
  for (const HalfSpace& h : system) normals.push_back(h.normal());
  return normals;
}

// Small entries, so that parallel, coplanar and otherwise degenerate normals are
// frequent; few half-spaces leave lines, many leave none; half of them surely have interior.
std::vector<HalfSpace> system_of_kind(int i, std::size_t d, RandomStream& random) {
  const std::size_t n = i % 3 == 0 ? 1 + uniform_index(d, random) : d + uniform_index(d + 4, random);
  const auto largest = 1 + static_cast<std::int64_t>(uniform_index(4, random));
  return i % 2 == 0 ? testing::random_system(n, largest, random, d)
                    : testing::random_feasible_system(n, largest, random, d);
}

void expect_linear_programs_agree(std::size_t d, int systems, std::uint64_t seed) {
  RandomStream random{seed};
  int with_interior = 0;
  for (int i = 0; i < systems; ++i) {
    const auto system = system_of_kind(i, d, random);
    const auto normals = normals_of(system);
    const auto minimal = minimal_set(system);
    ASSERT_EQ(minimal.has_value(), testing::lp_has_interior(normals)) << "d = " << d << ", system " << i;
    ASSERT_EQ(minimal.has_value(), has_interior(system));
    if (!minimal) continue;
    ++with_interior;
    ASSERT_EQ(normals_of(*minimal), testing::lp_minimal_set(normals)) << "d = " << d << ", system " << i;
  }
  EXPECT_GT(with_interior, systems / 2);
  EXPECT_LT(with_interior, systems);
}

TEST(MinimalSetInDimensions, AgreesWithLinearPrograms) {
  for (std::size_t d = 2; d <= 8; ++d) expect_linear_programs_agree(d, 60, d);
}

TEST(MinimalSetInDimensionsSlow, AgreesWithLinearProgramsOnTenThousandSystemsEach) {
  for (std::size_t d = 2; d <= 8; ++d) expect_linear_programs_agree(d, 10000, 100 + d);
}

std::optional<Cone> random_cone(std::size_t d, RandomStream& random) {
  Cone cone{d};
  const std::size_t n = uniform_index(d + 5, random);
  if (!cone.clip(testing::random_feasible_system(n, 4, random, d))) return std::nullopt;
  return cone;
}

TEST(ConeInDimensions, IsGeneratedByItsGenerators) {
  RandomStream random{1};
  int inside = 0;
  for (std::size_t d = 2; d <= 8; ++d) {
    for (int i = 0; i < 8; ++i) {
      const auto cone = random_cone(d, random).value();
      const auto generators = cone.generators();
      for (const IntegerVector& g : generators) ASSERT_TRUE(cone.contains(g));
      for (int k = 0; k < 10; ++k) {
        IntegerVector w = testing::random_vector(3, random, d);
        if (k % 2 == 0) w = w + w + cone.interior_direction();
        ASSERT_EQ(cone.contains(w), testing::is_combination<testing::WideInteger>(generators, w)) << d;
        inside += cone.contains(w) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(inside, 100);
}

TEST(ConeInDimensions, HasNoGeneratorTooMany) {
  RandomStream random{2};
  for (std::size_t d = 2; d <= 6; ++d) {
    for (int i = 0; i < 5; ++i) {
      const auto generators = random_cone(d, random)->generators();
      for (std::size_t k = 0; k < generators.size(); ++k) {
        auto rest = generators;
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(k));
        ASSERT_FALSE(testing::is_combination<testing::WideInteger>(rest, generators[k])) << d;
      }
    }
  }
}

TEST(ConeInDimensions, DoesNotDependOnTheOrderOfClipping) {
  RandomStream random{3};
  for (std::size_t d = 2; d <= 8; ++d) {
    for (int i = 0; i < 30; ++i) {
      auto system = system_of_kind(i, d, random);
      const auto reference = Cone::intersection(system);
      testing::shuffle(system, random);
      const auto other = Cone::intersection(system);
      ASSERT_EQ(other, reference);
      if (!reference) continue;
      ASSERT_EQ(other->minimal_set(), reference->minimal_set());
      if (d == 3) continue;
      ASSERT_EQ(other->generators(), reference->generators());
      ASSERT_EQ(other->interior_direction(), reference->interior_direction());
    }
  }
}

TEST(ConeInDimensions, PredictsWhatClippingDoes) {
  RandomStream random{4};
  int cut = 0, implied = 0, emptied = 0;
  for (std::size_t d = 2; d <= 8; ++d) {
    for (int i = 0; i < 40; ++i) {
      const auto cone = random_cone(d, random).value();
      // Combinations of facets are implied; random half-spaces cut.
      IntegerVector normal = testing::random_vector(4, random, d);
      if (i % 2 == 0 && !cone.facets().empty()) {
        normal = cone.facets().front().normal() + cone.facets().back().normal();
        if (i % 4 == 0) normal = -normal;
      }
      const HalfSpace h{normal};
      const auto clipped = cone.clipped(h);
      ASSERT_EQ(clipped == cone, cone.implies(h));
      ASSERT_EQ(!clipped.has_value(), cone.implies(h.opposite()));
      ASSERT_EQ(clipped.has_value() && clipped != cone, cone.is_cut_by(h));
      ++(cone.is_cut_by(h) ? cut : cone.implies(h) ? implied : emptied);
    }
  }
  EXPECT_GT(std::min({cut, implied, emptied}), 30);
}

TEST(ConeInDimensions, HasItsInteriorDirectionStrictlyInside) {
  RandomStream random{5};
  for (std::size_t d = 2; d <= 8; ++d) {
    for (int i = 0; i < 40; ++i) {
      const auto cone = random_cone(d, random).value();
      const IntegerVector w = cone.interior_direction();
      ASSERT_FALSE(w.is_zero());
      for (const HalfSpace& facet : cone.facets()) ASSERT_EQ(sign_of_dot(facet.normal(), w), 1);
    }
  }
}

// A system in space, in the first three of d features: as the cone in space, with lines added.
TEST(ConeInDimensions, AgreesWithTheConeInSpaceAtRightAnglesToLines) {
  RandomStream random{6};
  const auto widened = [](const IntegerVector& v, std::size_t d) {
    IntegerVector result(d);
    for (std::size_t k = 0; k < 3; ++k) result[k] = v[k];
    return result;
  };
  for (int i = 0; i < 300; ++i) {
    const std::size_t d = 4 + uniform_index(5, random);
    const auto system = testing::random_system(1 + uniform_index(9, random), 5, random);
    std::vector<HalfSpace> wide;
    for (const HalfSpace& h : system) wide.emplace_back(widened(h.normal(), d));
    const auto minimal = minimal_set(system);
    const auto found = minimal_set(wide);
    ASSERT_EQ(minimal.has_value(), found.has_value());
    if (!minimal) continue;
    ASSERT_EQ(minimal->size(), found->size());
    for (std::size_t k = 0; k < minimal->size(); ++k) {
      ASSERT_EQ(widened((*minimal)[k].normal(), d), (*found)[k].normal());
    }
  }
}

TEST(ConeInDimensions, KnowsTheOrthantsAndTheWholeSphere) {
  for (std::size_t d = 2; d <= 8; ++d) {
    Cone cone{d};
    EXPECT_EQ(cone.dimension(), d);
    EXPECT_EQ(cone.generators().size(), 2 * d);
    for (std::size_t k = 0; k < d; ++k) {
      IntegerVector axis(d);
      axis[k] = 1;
      EXPECT_TRUE(cone.is_cut_by(HalfSpace{axis}));
      EXPECT_TRUE(cone.clip(HalfSpace{axis}));
      EXPECT_FALSE(cone.clip(HalfSpace{-axis}));
      EXPECT_EQ(cone.facets().size(), k + 1);
      EXPECT_EQ(cone.generators().size(), 2 * d - k - 1);
    }
  }
  EXPECT_THROW((void)Cone{1}, std::invalid_argument);
  EXPECT_THROW((void)Cone{9}, std::invalid_argument);
}

TEST(ConeInDimensions, RefusesHalfSpacesOfOtherDimensions) {
  Cone cone{4};
  EXPECT_THROW((void)cone.clip(HalfSpace{{1, 0, 0}}), std::invalid_argument);
  EXPECT_THROW((void)Cone{}.clipped(HalfSpace{{1, 0}}), std::invalid_argument);
  EXPECT_THROW((void)minimal_set(std::vector{HalfSpace{{1, 0}}, HalfSpace{{1, 0, 0}}}), std::invalid_argument);
  EXPECT_NE(Cone{4}, Cone{5});
}

// Entries of 31 bits in four dimensions: the rays would need 93.
TEST(ConeInDimensions, SaysSoAndStaysAsItWasWhereRaysLeave64Bits) {
  RandomStream random{7};
  const std::int64_t largest = (std::int64_t{1} << 31) - 1;
  int refused = 0;
  for (int i = 0; i < 20; ++i) {
    Cone cone{4};
    for (const HalfSpace& h : testing::random_feasible_system(6, largest, random, 4)) {
      const Cone before = cone;
      try {
        ASSERT_TRUE(cone.clip(h));
      } catch (const std::overflow_error&) {
        ++refused;
        ASSERT_EQ(cone, before);
        ASSERT_EQ(cone.generators(), before.generators());
        break;
      }
    }
  }
  EXPECT_EQ(refused, 20);
}

// Up to the bound that the class promises, with the intermediate results beyond 128 bits that this takes.
TEST(ConeInDimensions, IsExactUpToThePromisedEntries) {
  RandomStream random{8};
  for (const auto& [d, largest] : {std::pair<std::size_t, std::int64_t>{4, 1200000}, {5, 27000}, {6, 2700}, {8, 180}}) {
    for (int i = 0; i < 5; ++i) {
      auto system = testing::random_feasible_system(d + 3, largest, random, d);
      const Cone cone = Cone::intersection(system).value();
      testing::shuffle(system, random);
      ASSERT_EQ(Cone::intersection(system).value(), cone);
      for (const HalfSpace& h : system) ASSERT_TRUE(cone.implies(h));
      for (const IntegerVector& g : cone.generators()) ASSERT_TRUE(cone.contains(g));
    }
  }
}

TEST(IrreducibleConflictInDimensions, NeedsEveryOneOfItsMembersAndAtMostOneMoreThanDimensions) {
  RandomStream random{9};
  std::set<std::size_t> largest_found;
  for (std::size_t d = 2; d <= 6; ++d) {
    std::size_t largest = 0;
    for (int i = 0; i < 60; ++i) {
      const auto system = testing::random_system(2 * d + uniform_index(4, random), 2, random, d);
      const auto conflict = irreducible_conflict(system);
      ASSERT_EQ(conflict.empty(), has_interior(system));
      largest = std::max(largest, conflict.size());
      ASSERT_LE(conflict.size(), d + 1);
      for (std::size_t k = 0; k < conflict.size(); ++k) {
        auto rest = conflict;
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(k));
        ASSERT_TRUE(has_interior(rest));
      }
    }
    EXPECT_EQ(largest, d + 1);
  }
}

TEST(HalfSpaceInDimensions, MeasuresTheSineOfTheAngleFromItsBoundary) {
  RandomStream random{10};
  for (std::size_t d = 2; d <= 8; ++d) {
    for (int i = 0; i < 50; ++i) {
      const HalfSpace h{testing::random_vector(9, random, d)};
      ASSERT_EQ(h.dimension(), d);
      ASSERT_NEAR(h.unit().norm(), 1.0, 1e-15);
      ASSERT_NEAR(h.margin(h.unit()), 1.0, 1e-15);
      const IntegerVector w = testing::random_vector(9, random, d);
      Direction real(static_cast<Eigen::Index>(d));
      for (std::size_t k = 0; k < d; ++k) real[static_cast<Eigen::Index>(k)] = static_cast<double>(w[k]);
      ASSERT_NEAR(h.margin(real), h.unit().dot(real), 1e-14);
      if (sign_of_dot(h.normal(), w) != 0) {
        ASSERT_EQ(h.contains(real), h.contains(w));
      }
    }
  }
}

}  // namespace
}  // namespace kith
