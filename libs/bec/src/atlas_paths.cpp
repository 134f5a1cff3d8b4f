// What the robot's paths show about whole paths, where single deviations from them do not tell everything.
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "atlas_builder.hpp"
#include "kith/bec/comparison.hpp"
#include "people_regret.hpp"

namespace kith {
namespace {

constexpr std::size_t kPathPeople = 32;   // who cover what is known so far
constexpr std::size_t kMostRounds = 8;    // of finding out how they err
constexpr double kToleratedShare = 0.01;  // of the regret before any lesson
constexpr PeopleRegret::Sample kManyStarts{.mdps = 64, .starts_per_mdp = 64};

// Somebody who satisfies everything known so far and yet errs.
struct Erring {
  Direction weights;
  double regret = 0.0;
};

// The half-space by which most of the regret is excluded, if there is any; of equal ones the first.
std::optional<HalfSpace> most_telling(const std::set<HalfSpace>& candidates, const std::vector<Erring>& people) {
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

}  // namespace

// If candidates' paths meet every state, nobody who satisfies all one-step constraints errs anywhere: a policy that no
// single deviation improves is optimal. Elsewhere a better path may need two deviations, the second from a state that
// no path meets. People who satisfy what is known so far show such paths: the robot's is compared with theirs, the
// comparisons that exclude most regret are added to what the starts show, and so on, until hardly any regret is left.
void AtlasBuilder::compare_whole_paths() {
  if (atlas_.tabulated_ || paths_meet_all_states_) return;
  PeopleRegret regret{atlas_, kManyStarts};
  Regions regions{atlas_.constraints_};
  auto known = atlas_.prior_;
  for (const auto& set : atlas_.one_step_sets_) known |= set;
  known = regions.minimal(known);
  std::map<std::size_t, ConstraintSet> shown;  // per demonstration what is added
  std::optional<double> tolerated;
  for (std::size_t round = 0; round < kMostRounds; ++round) {
    const Eigen::MatrixXd cover = people_within(atlas_.constraints_, known, kPathPeople);
    std::vector<Erring> people;
    std::map<HalfSpace, std::vector<DemoIndex>> starts_of;
    std::set<HalfSpace> candidates;
    double left = 0.0;
    for (Eigen::Index i = 0; i < cover.cols(); ++i) {
      Erring one{cover.col(i), 0.0};
      for (const auto& mistake : regret.mistakes(one.weights)) {
        const auto half_space = preference_of_robot(atlas_.domain_, mistake.advantage);
        if (!half_space || !counts(*half_space) || half_space->contains(one.weights)) continue;
        starts_of[*half_space].push_back(mistake.start);
        candidates.insert(*half_space);
        one.regret += mistake.regret;
      }
      left += one.regret;
      if (one.regret > 0.0) people.push_back(std::move(one));
    }
    if (people.empty()) break;
    if (!tolerated) {
      const Eigen::MatrixXd anybody = people_within(atlas_.constraints_, atlas_.prior_, kPathPeople);
      double before = 0.0;
      for (Eigen::Index i = 0; i < anybody.cols(); ++i) before += regret.of(anybody.col(i));
      tolerated = kToleratedShare * before;
    }
    bool is_new = false;
    while (left > *tolerated) {
      const auto telling = most_telling(candidates, people);
      if (!telling) break;
      const auto number = atlas_.constraints_.add(*telling);
      known.insert(number);
      is_new = true;
      for (const DemoIndex start : starts_of[*telling]) shown[start.value()].insert(number);
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
  for (const auto& [i, more] : shown) {
    auto& demo = atlas_.demos_[i];
    const auto& set = regions.minimal(atlas_.one_step_sets_[demo.one_step] | more);
    demo.one_step = static_cast<std::uint32_t>(atlas_.one_step_sets_.size());
    atlas_.one_step_sets_.push_back(set);
  }
}

}  // namespace kith
