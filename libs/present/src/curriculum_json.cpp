#include "kith/present/curriculum_json.hpp"

#include <nlohmann/json.hpp>

#include "kith/explain/words.hpp"
#include "kith/present/board_json.hpp"

namespace kith {
namespace {

Json demonstration_json(const Atlas& atlas, const CurriculumDemonstration& shown) {
  const auto& domain = atlas.domain();
  const auto world = atlas.id(shown.demo).mdp;
  auto json = board_json(domain, atlas.id(shown.demo));
  json.update(path_json(domain, world, shown.contrast.robot));
  json["reason"] = shown.reason;
  json["conveys"] = sentences_json(domain, shown.conveys);
  json["alternative"] = path_json(domain, world, shown.contrast.alternative);
  json["decisive"] = step_json(domain, world, shown.contrast.robot, shown.contrast.decisive);
  json["runs"] = runs_json(domain, world, shown.runs);
  json["flip"] = nullptr;
  if (shown.flip) {
    const auto id = atlas.id(shown.flip->demo);
    json["flip"] = board_json(domain, id);
    json["flip"].update(path_json(domain, id.mdp, shown.flip->robot));
    json["flip"]["text"] = flip_in_words(atlas, shown.contrast, *shown.flip);
  }
  return json;
}

Json test_json(const Atlas& atlas, const CurriculumTest& test) {
  const auto id = atlas.id(test.demo);
  auto json = board_json(atlas.domain(), id);
  json.update(path_json(atlas.domain(), id.mdp, atlas.trajectory(test.demo)));
  json["runs"] = runs_json(atlas.domain(), id.mdp, test.runs);
  json["difficulty"] = name_of(test.difficulty);
  json["share_right"] = test.share_right;
  json["covers"] = sentences_json(atlas.domain(), test.covers);
  return json;
}

}  // namespace

Json curriculum_json(const Atlas& atlas, const Curriculum& curriculum, std::uint64_t seed, const std::string& program) {
  Json components = Json::array();
  for (std::size_t i = 0; i < curriculum.components.size(); ++i) {
    const auto& component = curriculum.components[i];
    Json demonstrations = Json::array();
    for (const auto& shown : component.demonstrations) demonstrations.push_back(demonstration_json(atlas, shown));
    Json tests = Json::array();
    for (const auto& test : component.tests) tests.push_back(test_json(atlas, test));
    components.push_back({{"number", i + 1},
                          {"name", component.name},
                          {"sentences", sentences_json(atlas.domain(), component.constraints)},
                          {"area_sr", component.area_sr},
                          {"demonstrations", demonstrations},
                          {"tests", tests}});
  }
  Json skipped = Json::array();
  for (const auto& one : curriculum.skipped) skipped.push_back({{"name", one.name}, {"why", one.why}});
  return {{"schema", "kith.curriculum/1"},
          {"title", "What will the robot do?"},  // the domain's own title may tell
          {"program", program},
          {"seed", seed},
          {"domain", board_domain_json(atlas.domain())},
          {"components", components},
          {"skipped", skipped}};
}

}  // namespace kith
