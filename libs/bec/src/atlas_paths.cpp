// What the robot's paths show about whole paths, where single deviations from them do not tell everything.
#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "atlas_builder.hpp"
#include "kith/bec/comparison.hpp"
#include "kith/bec/near_miss.hpp"
#include "kith/core/assert.hpp"
#include "people_regret.hpp"

namespace kith {
namespace {

constexpr std::size_t kPathPeople = 32;   // who cover what is known so far
constexpr std::size_t kMostRounds = 8;    // of finding out how they err
constexpr std::array kMisses{0.5, 2.0};   // of facets, see near_misses()
constexpr double kToleratedShare = 0.01;  // of the regret before any lesson
constexpr PeopleRegret::Sample kManyStarts{.mdps = 64, .starts_per_mdp = 64};

// Somebody who satisfies everything known so far and yet errs.
struct Erring {
  Direction weights;
  double regret = 0.0;
};

// The half-space by which most of the regret is excluded, if there is any; of equal ones the first.
template <typename Candidates>
std::optional<HalfSpace> most_telling(const Candidates& candidates, const std::vector<Erring>& people) {
  std::optional<HalfSpace> best;
  double most = 0.0;
  for (const HalfSpace& candidate : candidates) {
    double excluded = 0.0;
    for (const Erring& one : people) excluded += candidate.contains(one.weights) ? 0.0 : one.regret;
    if (excluded <= most) continue;
    most = excluded;
    best = candidate;
  }
  return best;
}

// Regret of the people in the columns [first, people.cols()), in all.
double regret_of(PeopleRegret& regret, const Eigen::MatrixXd& people, Eigen::Index first) {
  double sum = 0.0;
  for (Eigen::Index i = first; i < people.cols(); ++i) sum += regret.of(people.col(i));
  return sum;
}

}  // namespace

// If candidates' paths meet every state, nobody who satisfies all one-step constraints errs anywhere: a policy that no
// single deviation improves is optimal. Elsewhere a better path may need two deviations, the second from a state that
// no path meets. People who satisfy what is known so far show such paths: the robot's is compared with theirs, the
// comparisons that exclude most regret are added to what is known, and so on, until hardly any regret is left. Each
// start shows those comparisons with paths from there that follow from what is known in the end. How much regret is
// left then is measured with people who had no part in that.
void AtlasBuilder::compare_whole_paths() {
  if (tables_ || paths_meet_all_states_) return;
  PeopleRegret regret{partitions(), kManyStarts};
  Regions regions{atlas_.constraints_};
  auto known = atlas_.prior_;
  for (const auto& set : atlas_.one_step_sets_) known |= set;
  known = regions.minimal(known);
  std::map<std::size_t, std::set<HalfSpace>> shown;  // per demonstration all comparisons met
  const auto meet = [&](const PeopleRegret::Mistake& mistake) {
    auto half_space = preference_of_robot(atlas_.domain_, mistake.advantage);
    if (half_space && !counts(*half_space)) half_space.reset();
    if (half_space) shown[mistake.start.value()].insert(*half_space);
    return half_space;
  };

  const Eigen::MatrixXd anybody = people_within(atlas_.prior_, kPathPeople);
  const double before = regret_of(regret, anybody, 0);
  for (std::size_t round = 0; round < kMostRounds; ++round) {
    const Eigen::MatrixXd cover = people_within(known, kPathPeople);
    std::vector<Erring> people;
    const auto in_order = [&](const HalfSpace& a, const HalfSpace& b) { return is_before(a, b); };
    std::set<HalfSpace, decltype(in_order)> candidates{in_order};
    double left = 0.0;
    for (Eigen::Index i = 0; i < cover.cols(); ++i) {
      Erring one{cover.col(i), 0.0};
      for (const auto& mistake : regret.mistakes(one.weights)) {
        const auto half_space = meet(mistake);
        if (!half_space || half_space->contains(one.weights)) continue;
        candidates.insert(*half_space);
        one.regret += mistake.regret;
      }
      left += one.regret;
      if (one.regret > 0.0) people.push_back(std::move(one));
    }
    if (people.empty()) break;
    if (round == 0) {
      for (Eigen::Index i = 0; i < anybody.cols(); ++i) {
        for (const auto& mistake : regret.mistakes(anybody.col(i))) meet(mistake);
      }
    }
    bool is_new = false;
    while (left > kToleratedShare * before) {
      const auto telling = most_telling(candidates, people);
      if (!telling) break;
      const auto number = atlas_.constraints_.add(*telling);
      known.insert(number);
      is_new = true;
      std::erase_if(people, [&](const Erring& one) {
        if (telling->contains(one.weights)) return false;
        left -= one.regret;
        return true;
      });
      candidates.erase(*telling);
    }
    if (!is_new) break;
    known = regions.minimal(known);
  }

  const double after = regret_of(regret, people_within(known, 2 * kPathPeople), kPathPeople);
  atlas_.regret_left_ = before > 0.0 ? after / before : 0.0;
  if (shown.empty()) return;
  Cone region{atlas_.domain_.num_features()};
  const bool has_room = region.clip(atlas_.constraints_.half_spaces(known));
  KITH_ASSERT(has_room);  // the robot's weights lie inside
  for (const double miss : kMisses) {
    for (const auto& weights : near_misses(region, region.facets(), miss)) {
      for (const auto& mistake : regret.mistakes(weights)) meet(mistake);
    }
  }
  for (const auto& [i, comparisons] : shown) show_more(atlas_.starts_[i], comparisons, region);
}

// What is added to what a start shows: the comparisons that follow from the region.
void AtlasBuilder::show_more(Atlas::Start& start, const std::set<HalfSpace>& comparisons, const Cone& region) {
  auto all = atlas_.constraints_.half_spaces(atlas_.one_step_sets_[start.one_step]);
  std::copy_if(comparisons.begin(), comparisons.end(), std::back_inserter(all),
               [&](const HalfSpace& half_space) { return region.implies(half_space); });
  const auto minimal = minimal_set(all);
  KITH_ASSERT(minimal.has_value());
  ConstraintSet set = atlas_.no_constraints();
  for (const HalfSpace& half_space : *minimal) set.insert(atlas_.constraints_.add(half_space));
  start.one_step = static_cast<std::uint32_t>(atlas_.one_step_sets_.size());
  atlas_.one_step_sets_.push_back(std::move(set));
}

}  // namespace kith
