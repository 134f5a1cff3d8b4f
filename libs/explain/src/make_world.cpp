// Worlds that teach or test one constraint alone, made by changing cells of a map.
#include <algorithm>
#include <set>
#include <stdexcept>
#include <tuple>

#include "kith/domains/domain_file.hpp"
#include "kith/domains/variation.hpp"
#include "kith/explain/target.hpp"
#include "kith/explain/words.hpp"
#include "target_region.hpp"

namespace kith {
namespace {

using Rows = std::vector<std::string>;

// Symbols that may become one another: floor, walls, terrain and stations.
std::string placeable(const GridMap& map) {
  std::string symbols;
  for (const auto& entry : map.legend()) {
    if (entry.start || !entry.item.empty() || entry.content.goal || !entry.content.destination_of.empty()) continue;
    symbols += entry.symbol;
  }
  return symbols;
}

// Whether some path of the robot conveys exactly the target, by its one-step comparisons: what the atlas of the world
// would say, without making one. Ties may count in the atlas and not here; the atlas decides.
class QuickLook {
 public:
  QuickLook(const Domain& domain, const Cone& prior, const std::vector<HalfSpace>& target)
      : mdp_{domain.mdp(MdpIndex{0})}, prior_{prior}, target_{target} {
    const auto plan = plan_exactly(mdp_, domain.weights().integer);
    if (!plan.solution) return;
    regions_.resize(mdp_.num_states());
    for (StateIndex s{0}; s.value() < mdp_.num_states() && !found_; ++s) {
      found_ = region(*plan.solution, s).minimal_set() == target_;
    }
  }

  [[nodiscard]] bool found() const noexcept { return found_; }

 private:
  const Cone& region(const ExactSolution& robot, StateIndex s) {
    auto& known = regions_[s.value()];
    if (known) return *known;
    const auto choices = mdp_.choices(s);
    const auto& own = mdp_.outcomes(choices[robot.canonical_choice[s.value()]]).front();
    auto cone = mdp_.is_terminal(own.next) ? prior_ : region(robot, own.next);
    for (const auto& choice : choices) {
      const auto& step = mdp_.outcomes(choice).front();
      const auto difference =
          robot.feature_counts[s.value()] - (mdp_.integer_features(step) + robot.feature_counts[step.next.value()]);
      if (!difference.is_zero()) static_cast<void>(cone.clip(HalfSpace{difference}));
    }
    regions_[s.value()] = std::move(cone);
    return *regions_[s.value()];
  }

  const Mdp& mdp_;
  const Cone& prior_;
  const std::vector<HalfSpace>& target_;
  std::vector<std::optional<Cone>> regions_;
  bool found_ = false;
};

// Goes through changed maps, those with fewer changes first.
class WorldMaker {
 public:
  WorldMaker(const Atlas& atlas, const GridMap& map, std::string_view text, const HalfSpace& constraint,
             Purpose purpose, const MakeWorldOptions& options)
      : atlas_{atlas},
        domain_{atlas.domain()},
        map_{map},
        text_{text},
        constraint_{constraint},
        purpose_{purpose},
        options_{options},
        target_{detail::target_facets(atlas.prior_cone(), constraint)},
        symbols_{placeable(map)} {
    if (options.max_changes == 0) throw std::invalid_argument{"make_world: at least one cell must change"};
  }

  std::optional<MadeWorld> make() {
    const auto bases = nearest_first();
    for (std::size_t n = 1; n <= options_.max_changes && !made_; ++n) {
      for (const auto base : bases) {
        base_ = base;
        change(map_.draw(base, std::nullopt), n, 0);
        if (made_ || states_ >= options_.max_states) break;
      }
    }
    return std::move(made_);
  }

 private:
  // Worlds by how little the nearest demonstration conveys besides the constraint, then by how much there is to see.
  [[nodiscard]] std::vector<MdpIndex> nearest_first() const {
    constexpr std::size_t kFar = 1000;
    std::vector<std::size_t> besides(domain_.num_mdps(), kFar);
    for (StartIndex demo{0}; demo.value() < atlas_.num_states(); ++demo) {
      if (!atlas_.is_candidate(demo)) continue;
      const auto half_spaces = atlas_.constraints().half_spaces(atlas_.one_step(demo));
      const bool conveys = std::find(half_spaces.begin(), half_spaces.end(), constraint_) != half_spaces.end();
      auto& best = besides[atlas_.id(demo).mdp.value()];
      if (conveys) best = std::min(best, half_spaces.size());
    }
    const auto things = [&](MdpIndex m) {
      const auto there = domain_.present_things(m);
      return std::count(there.begin(), there.end(), true);
    };
    std::vector<MdpIndex> bases;
    for (MdpIndex m{0}; m.value() < domain_.num_mdps(); ++m) bases.push_back(m);
    std::stable_sort(bases.begin(), bases.end(), [&](MdpIndex a, MdpIndex b) {
      return std::tuple{besides[a.value()], things(a)} < std::tuple{besides[b.value()], things(b)};
    });
    return bases;
  }

  // Changes n more cells, from cell number `first` on.
  void change(Rows rows, std::size_t n, std::size_t first) {
    if (n == 0) return look_at(rows);
    const auto width = rows.front().size();
    for (std::size_t cell = first; cell < rows.size() * width; ++cell) {
      char& symbol = rows[cell / width][cell % width];
      const char own = symbol;
      if (symbols_.find(own) == std::string::npos) continue;
      for (const char other : symbols_) {
        if (other == own) continue;
        symbol = other;
        change(rows, n - 1, cell + 1);
        if (made_ || states_ >= options_.max_states) return;
      }
      symbol = own;
    }
  }

  void look_at(const Rows& rows) {
    if (!seen_.insert(rows).second) return;
    auto text = with_one_map(text_, domain_.id() + "-made", rows);
    if (!text) return;
    auto domain = parse_domain(*text, "made").domain.value();
    states_ += domain.num_starts();
    if (purpose_ == Purpose::kTeach && !QuickLook{domain, atlas_.prior_cone(), target_}.found()) return;
    if (!plan_exactly(domain.mdp(MdpIndex{0}), domain.weights().integer).solution) return;
    Atlas atlas{std::move(domain)};
    const auto demo = simplest_isolating(atlas, constraint_, purpose_);
    if (!demo) return;
    std::vector<CellChange> changes;
    const auto before = map_.draw(base_, std::nullopt);
    for (std::size_t row = 0; row < rows.size(); ++row) {
      for (std::size_t column = 0; column < rows[row].size(); ++column) {
        if (rows[row][column] == before[row][column]) continue;
        changes.push_back({{static_cast<int>(column) + 1, map_.height() - static_cast<int>(row)},
                           before[row][column],
                           rows[row][column]});
      }
    }
    made_ = MadeWorld{*std::move(text), base_, std::move(changes), std::move(atlas), *demo};
  }

  const Atlas& atlas_;
  const Domain& domain_;
  GridMap map_;
  std::string_view text_;
  const HalfSpace& constraint_;
  Purpose purpose_;
  const MakeWorldOptions& options_;
  std::vector<HalfSpace> target_;
  std::string symbols_;
  MdpIndex base_;
  std::set<Rows> seen_;
  std::size_t states_ = 0;
  std::optional<MadeWorld> made_;
};

std::string name_of(const GridMap& map, char symbol) {
  for (const auto& entry : map.legend()) {
    if (entry.symbol != symbol) continue;
    if (entry.content.wall) return "wall";
    if (!entry.content.terrain.empty()) return entry.content.terrain;
    if (!entry.station.empty()) return entry.station;
  }
  return "floor";
}

}  // namespace

bool can_make_worlds(const Domain& domain) { return domain.map() && domain.is_exact(); }

std::optional<MadeWorld> make_world(const Atlas& atlas, std::string_view text, const HalfSpace& constraint,
                                    Purpose purpose, const MakeWorldOptions& options) {
  const auto map = atlas.domain().map();
  if (!map || !can_make_worlds(atlas.domain())) return std::nullopt;
  return WorldMaker{atlas, *map, text, constraint, purpose, options}.make();
}

std::string change_in_words(const GridMap& map, const CellChange& change) {
  return name_of(map, change.from) + " at " + cell_text(map, change.cell) + " becomes " + name_of(map, change.to);
}

}  // namespace kith
