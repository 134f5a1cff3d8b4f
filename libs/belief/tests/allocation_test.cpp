// Updating beliefs of usual size allocates nothing: particles stay where they
// are and what is needed in between lives on the stack.

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

#include "kith/belief/team_belief.hpp"
#include "script.hpp"

// Sanitizers bring their own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {
std::atomic<std::size_t> num_allocations{0};
}  // namespace

// Inlined without its partner, the compiler takes one of them for a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++num_allocations;
  if (void* const memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc{};
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace kith {
namespace {

using kith::testing::lower_hemisphere;
using kith::testing::random_list;

template <typename Action>
std::size_t allocations_of(Action action) {
  const std::size_t before = num_allocations;
  action();
  return num_allocations - before;
}

TEST(Allocation, IsCounted) {
  EXPECT_GE(allocations_of([] { std::vector<int>(3).shrink_to_fit(); }), 1u);
}

TEST(Allocation, IsNotNeededToUpdateAParticleBelief) {
  RandomStream random{1};
  ParticleBelief belief{lower_hemisphere(), {.resample_below = 1.0}};
  const HalfSpaceLikelihood likelihood{0.8};
  const auto list = random_list(3, random);
  const std::vector<std::vector<HalfSpace>> alternatives{list, random_list(2, random)};
  double read = 0.0;
  EXPECT_EQ(allocations_of([&] {
              belief.observe(list, likelihood, random.split(1));
              belief.observe_any(alternatives, likelihood, random.split(2));
              belief.diffuse(0.05, random.split(3));
              read += belief.mass_in(list) + belief.log_evidence(list, likelihood) + belief.spread();
            }),
            0u);
  EXPECT_GT(belief.num_resamplings(), 0u);
  EXPECT_NE(read, 0.0);
}

TEST(Allocation, IsNotNeededWhenATeamSeesADemonstrationOrHearsFeedback) {
  RandomStream random{2};
  TeamBelief team{lower_hemisphere(), {}, {RandomStream{1}, RandomStream{2}, RandomStream{3}}, RandomStream{4}};
  const auto list = random_list(3, random);
  EXPECT_EQ(allocations_of([&] {
              for (std::uint64_t period = 1; period <= 5; ++period) {
                team.observe_demonstrations(list, period);
                team.observe_feedback(list, period);
              }
            }),
            0u);
}

}  // namespace
}  // namespace kith

#endif
