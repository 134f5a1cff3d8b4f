// Writes paths that kith has judged, for a page's judge to agree with: one line of JSON for each world of each built-in
// domain, with the robot's own path from every start, and random ones; where a path is worth what is to be expected,
// also with every first move from every start.
//
//   kith_judged_paths [DOMAIN...]
#include <iostream>
#include <nlohmann/json.hpp>

#include "kith/core/distributions.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/domains/judgement.hpp"
#include "kith/explain/move_table.hpp"
#include "kith/live/world_json.hpp"

namespace kith {
namespace {

constexpr std::size_t kRandomPaths = 1200;  // of each domain

using Actions = std::vector<std::size_t>;

// Mostly what the robot does, now and then something else, until the end or until somebody has had enough.
Actions random_path(const Atlas& atlas, StartIndex start_index, RandomStream& random) {
  constexpr std::size_t kLongest = 80;
  const auto [world, start] = atlas.id(start_index);
  const auto& mdp = atlas.domain().mdp(world);
  const auto others = uniform_index(4, random);  // in how many of ten steps
  Actions actions;
  for (auto s = start; !mdp.is_terminal(s) && actions.size() < kLongest;) {
    const auto choices = mdp.choices(s);
    const Choice* taken = &choices[uniform_index(choices.size(), random)];
    if (uniform_index(10, random) >= others) {
      taken = &*std::ranges::find(choices, atlas.action(atlas.index({world, s})), &Choice::action);
    }
    actions.push_back(taken->action.value());
    s = likeliest_outcome(mdp, s, *taken).next;
    if (uniform_index(40, random) == 0) break;
  }
  return actions;
}

class Lines {
 public:
  explicit Lines(const Atlas& atlas)
      : atlas_{atlas},
        worlds_(atlas.domain().num_mdps(), Json::array()),
        moves_(atlas.domain().num_mdps(), Json::array()) {}

  void add(StartIndex start_index, const Actions& actions, bool for_ever) {
    const auto judged = judged_path(atlas_, start_index, actions, for_ever);
    if (for_ever && !judged.is_legal) return;
    const auto& robot = atlas_.feature_counts(start_index);
    Json one{{"start", atlas_.id(start_index).start.value()},
             {"robot", std::vector<std::int64_t>(robot.begin(), robot.end())},
             {"actions", actions},
             {"repeats_from", nullptr},
             {"finished", judged.is_finished && judged.is_legal},
             {"right", judged.counts && judge_path(atlas_.domain(), robot, *judged.counts).is_right},
             {"counts", nullptr}};
    if (for_ever) one["repeats_from"] = *judged.path.repeats_from;
    if (judged.counts) one["counts"] = std::vector<std::int64_t>(judged.counts->begin(), judged.counts->end());
    worlds_[atlas_.id(start_index).mdp.value()].push_back(std::move(one));
  }

  // The robot goes on as ever behind the move.
  void add_moves(StartIndex start_index) {
    const auto [world, start] = atlas_.id(start_index);
    const auto& robot = atlas_.feature_counts(start_index);
    const auto choices = atlas_.domain().mdp(world).choices(start);
    for (std::size_t c = 0; c < choices.size(); ++c) {
      moves_[world.value()].push_back(
          {{"start", start.value()},
           {"robot", std::vector<std::int64_t>(robot.begin(), robot.end())},
           {"action", choices[c].action.value()},
           {"right", judge_path(atlas_.domain(), robot, atlas_.deviation_counts(start_index, c)).is_right}});
    }
  }

  void print() const {
    for (std::size_t world = 0; world < worlds_.size(); ++world) {
      if (worlds_[world].empty()) continue;
      std::cout << Json{{"domain", atlas_.domain().id()},
                        {"judge", judge_json(atlas_.domain())},
                        {"table", judged_table_json(atlas_, MdpIndex{world})},
                        {"paths", worlds_[world]},
                        {"moves", moves_[world]}}
                << '\n';
    }
  }

 private:
  const Atlas& atlas_;
  std::vector<Json> worlds_, moves_;
};

void print_paths(const std::string& name) {
  const Atlas atlas{load_domain(name)};
  Lines lines{atlas};
  RandomStream random{38};
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
    if (!atlas.domain().is_exact()) lines.add_moves(start);
    if (!atlas.is_candidate(start)) continue;
    const auto path = answerable_path(atlas, start);
    if (!path) continue;
    Actions actions;
    for (const auto action : path->actions) actions.push_back(action.value());
    lines.add(start, actions, path->repeats_from.has_value());
  }
  for (std::size_t i = 0; i < kRandomPaths; ++i) {
    const StartIndex start{uniform_index(atlas.num_states(), random)};
    const auto actions = random_path(atlas, start, random);
    lines.add(start, actions, false);
    if (atlas.domain().mdp(MdpIndex{0}).discount() < 1.0) lines.add(start, actions, true);
  }
  lines.print();
}

}  // namespace
}  // namespace kith

int main(int argc, char** argv) {
  std::vector<std::string> names(argv + 1, argv + argc);
  if (names.empty()) {
    for (const auto& domain : kith::built_in_domains()) names.emplace_back(domain.name);
  }
  for (const auto& name : names) kith::print_paths(name);
}
