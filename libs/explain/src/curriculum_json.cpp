#include "kith/explain/curriculum_json.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "kith/explain/board_json.hpp"
#include "kith/explain/move_table.hpp"
#include "kith/explain/words.hpp"

namespace kith {
namespace {

// The tables of moves of worlds: each once, as worlds often differ in nothing but what moves count.
class Tables {
 public:
  explicit Tables(const Atlas& atlas) : atlas_{atlas} {}

  // A board on which somebody drives the robot, and what the robot's own path counts.
  void add_start(Json& json, StartIndex start_index) {
    const auto id = atlas_.id(start_index);
    const auto& counts = atlas_.feature_counts(start_index);
    json["state"] = id.start.value();
    json["counts"] = std::vector<std::int64_t>(counts.begin(), counts.end());
    const auto key = std::to_string(id.mdp.value());
    starts_[key].push_back(id.start.value());
    if (worlds_.contains(key)) return;
    auto table = judged_table_json(atlas_, id.mdp);
    Json world;
    for (const char* own : {"counts", "kinds"}) {
      world[own] = std::move(table[own]);
      table.erase(own);
    }
    auto at = std::find(moves_.begin(), moves_.end(), table);
    if (at == moves_.end()) at = moves_.insert(moves_.end(), std::move(table));
    world["moves"] = at - moves_.begin();
    worlds_[key] = std::move(world);
  }
  [[nodiscard]] Json json() && {
    for (std::size_t i = 0; i < moves_.size(); ++i) leave_out_of_reach(i);
    return {{"moves", std::move(moves_)}, {"worlds", std::move(worlds_)}};
  }

 private:
  // States that no board leads to are left empty.
  void leave_out_of_reach(std::size_t number) {
    auto& moves = moves_[number];
    if (moves.contains("outcomes")) return;  // a start leads to most of its world
    std::vector<bool> is_reached(moves["next"].size(), false);
    std::vector<std::size_t> edge;
    const auto reach = [&](std::size_t state) {
      if (!is_reached[state]) edge.push_back(state);
      is_reached[state] = true;
    };
    for (const auto& [key, starts] : starts_) {
      if (worlds_[key]["moves"] != number) continue;
      for (const auto start : starts) reach(start);
    }
    while (!edge.empty()) {
      const auto state = edge.back();
      edge.pop_back();
      for (const auto& next : moves["next"][state]) {
        if (next >= 0) reach(next.get<std::size_t>());
      }
    }
    for (std::size_t s = 0; s < is_reached.size(); ++s) {
      if (is_reached[s]) continue;
      moves["frames"][s] = nullptr;
      moves["next"][s] = Json::array();
      for (const auto& [key, starts] : starts_) {
        if (worlds_[key]["moves"] == number) worlds_[key]["counts"][s] = "";
      }
    }
  }

  const Atlas& atlas_;
  Json moves_ = Json::array(), worlds_ = Json::object();
  std::map<std::string, std::vector<std::size_t>> starts_;  // by world
};

Json demonstration_json(const Atlas& atlas, const CurriculumDemonstration& shown, Tables& tables) {
  const auto& domain = atlas.domain();
  const auto world = atlas.id(shown.start).mdp;
  auto json = board_json(domain, atlas.id(shown.start));
  json.update(path_json(domain, world, shown.contrast.robot));
  tables.add_start(json, shown.start);
  json["reason"] = shown.reason;
  json["brackets"] = brackets_json(domain, shown.brackets);
  json["conveys"] = sentences_json(domain, shown.conveys);
  json["alternative"] = path_json(domain, world, shown.contrast.alternative);
  json["decisive"] = step_json(domain, world, shown.contrast.robot, shown.contrast.decisive);
  json["runs"] = runs_json(domain, world, shown.runs);
  json["first"] = shown.is_first;
  return json;
}

Json test_json(const Atlas& atlas, const CurriculumTest& test, Tables& tables) {
  const auto id = atlas.id(test.start);
  auto json = board_json(atlas.domain(), id);
  json.update(path_json(atlas.domain(), id.mdp, atlas.trajectory(test.start)));
  tables.add_start(json, test.start);
  json["runs"] = runs_json(atlas.domain(), id.mdp, test.runs);
  json["difficulty"] = name_of(test.difficulty);
  json["share_right"] = test.share_right;
  json["is_shortest_wrong"] = test.is_shortest_wrong;
  json["first"] = test.is_first;
  json["covers"] = sentences_json(atlas.domain(), test.covers);
  return json;
}

}  // namespace

Json update_json(const UpdateInWords& update) {
  return {{"text", update.text}, {"now", update.now}, {"still", update.still}, {"news", update.news}};
}

Json curriculum_json(const Atlas& atlas, const Curriculum& curriculum, std::uint64_t seed, const std::string& program) {
  Tables tables{atlas};
  Json components = Json::array();
  for (std::size_t i = 0; i < curriculum.components.size(); ++i) {
    const auto& component = curriculum.components[i];
    Json demonstrations = Json::array();
    for (const auto& shown : component.demonstrations) {
      demonstrations.push_back(demonstration_json(atlas, shown, tables));
    }
    Json tests = Json::array();
    for (const auto& test : component.tests) tests.push_back(test_json(atlas, test, tables));
    components.push_back({{"number", i + 1},
                          {"name", component.name},
                          {"sentences", sentences_json(atlas.domain(), component.constraints)},
                          {"area_sr", component.area_sr},
                          {"demonstrations", demonstrations},
                          {"tests", tests}});
  }
  Json fresh = Json::array();
  for (const auto& test : curriculum.fresh) fresh.push_back(test_json(atlas, test, tables));
  Json endless;
  if (curriculum.endless) {
    const auto id = atlas.id(*curriculum.endless);
    endless = board_json(atlas.domain(), id);
    endless.update(path_json(atlas.domain(), id.mdp, atlas.trajectory(*curriculum.endless)));
  }
  Json skipped = Json::array();
  for (const auto& one : curriculum.skipped) skipped.push_back({{"name", one.name}, {"why", one.why}});
  Json document{{"schema", "kith.curriculum/1"},
                {"title", "What will the robot do?"},  // the domain's own title may tell
                {"program", program},
                {"seed", seed},
                {"domain", board_domain_json(atlas.domain())},
                {"judge", judge_json(atlas.domain())},
                {"tables", std::move(tables).json()},
                {"max_actions", max_answer_actions(atlas.domain())},
                {"components", components},
                {"fresh", fresh},
                {"endless", endless},
                {"skipped", skipped}};
  if (curriculum.update) document["update"] = update_json(*curriculum.update);
  if (auto explained = explained_to_people(atlas.domain()); !explained.empty())
    document["explained"] = std::move(explained);
  return document;
}

Json for_page(Json curriculum) {
  const auto shorten = [](Json& path) {
    Json actions = Json::array();
    for (const auto& frame : path["frames"]) {
      if (!frame["action"].is_null()) actions.push_back(frame["action"]);
    }
    path.erase("frames");
    path["actions"] = std::move(actions);
  };
  const auto shorten_all = [&](Json& boards) {
    for (auto& board : boards) {
      if (!board["runs"].is_null()) continue;
      shorten(board);
      if (board.contains("alternative")) shorten(board["alternative"]);
    }
  };
  for (auto& component : curriculum["components"]) {
    shorten_all(component["demonstrations"]);
    shorten_all(component["tests"]);
  }
  shorten_all(curriculum["fresh"]);
  return curriculum;
}

}  // namespace kith
