#include "kith/present/audit_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "kith/explain/curriculum.hpp"
#include "kith/explain/words.hpp"
#include "kith/present/board_json.hpp"

namespace kith {

AuditCounts counts_of(const AuditReport& report, std::size_t component) {
  AuditCounts counts;
  for (const auto& person : report.people) {
    switch (person.components.at(component).understanding) {
      case Understanding::kUnderstands:
        ++counts.understand;
        break;
      case Understanding::kCannotTell:
        ++counts.cannot_tell;
        break;
      case Understanding::kMisconception:
        ++counts.misconception;
        break;
      case Understanding::kNotTaught:
        ++counts.not_taught;
        break;
    }
  }
  return counts;
}

std::vector<SharedMisconception> shared_misconceptions(const AuditReport& report) {
  struct Group {
    std::size_t people = 0;
    std::map<std::string, std::size_t> thinks;
  };
  std::map<std::pair<std::size_t, std::string>, Group> groups;  // by component and fact
  for (const auto& person : report.people) {
    for (const auto& audit : person.components) {
      if (audit.understanding != Understanding::kMisconception) continue;
      auto& group = groups[{audit.component, audit.misconception->fact}];
      ++group.people;
      ++group.thinks[audit.misconception->thinks];
    }
  }
  std::vector<SharedMisconception> shared;
  for (const auto& [key, group] : groups) {
    std::vector<std::pair<std::size_t, std::string>> thinks;
    for (const auto& [text, people] : group.thinks) thinks.emplace_back(people, text);
    std::stable_sort(thinks.begin(), thinks.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    SharedMisconception one{.component = key.first, .fact = key.second, .thinks = {}, .people = group.people};
    for (auto& [people, text] : thinks) one.thinks.push_back(std::move(text));
    shared.push_back(std::move(one));
  }
  std::stable_sort(shared.begin(), shared.end(), [](const auto& a, const auto& b) { return a.people > b.people; });
  return shared;
}

std::string in_words(Understanding understanding) {
  switch (understanding) {
    case Understanding::kUnderstands:
      return "understands";
    case Understanding::kMisconception:
      return "has a misconception";
    case Understanding::kNotTaught:
      return "not taught yet";
    case Understanding::kCannotTell:
      break;
  }
  return "cannot tell yet";
}

std::string advice_in_words(const ComponentAudit& audit) {
  switch (audit.understanding) {
    case Understanding::kUnderstands:
      return audit.test_after == 0 ? "no test needed for " + std::to_string(kLongestBreak) + " periods"
                                   : "test again after " + counted(audit.test_after, "period") + " without lessons";
    case Understanding::kMisconception:
      return "show the demonstration, then test in the same lesson";
    case Understanding::kCannotTell:
      return "test in the next lesson";
    case Understanding::kNotTaught:
      break;
  }
  return "";
}

namespace {

Json demo_json(const Atlas& atlas, std::optional<DemoIndex> demo) {
  if (!demo) return nullptr;
  auto json = board_json(atlas.domain(), atlas.id(*demo));
  json["mdp"] = atlas.id(*demo).mdp.value();
  json["start_state"] = atlas.id(*demo).start.value();
  return json;
}

Json misconception_json(const Atlas& atlas, const LikelyMisconception& misconception) {
  const auto& domain = atlas.domain();
  Json answers = Json::array();
  for (const auto& answer : misconception.answers) {
    const auto id = atlas.id(answer.demo);
    answers.push_back({{"period", answer.period},
                       {"test", answer.test},
                       {"mdp", id.mdp.value()},
                       {"start", id.start.value()},
                       {"factor", answer.factor ? Json(*answer.factor) : Json{}},
                       {"text", answer.text}});
  }
  const auto satisfied = misconception.misbelief.satisfied();
  return {{"constraint", sentences_json(domain, std::vector{misconception.misbelief.violated}).front()},
          {"satisfied", satisfied ? sentences_json(domain, std::vector{*satisfied}).front() : Json{}},
          {"probability", misconception.probability},
          {"thinks", misconception.thinks},
          {"fact", misconception.fact},
          {"answers", answers},
          {"show", demo_json(atlas, misconception.show)},
          {"reason", misconception.reason.empty() ? Json{} : Json(misconception.reason)}};
}

Json component_json(const Atlas& atlas, const ComponentAudit& audit) {
  const auto advice = advice_in_words(audit);
  return {
      {"component", audit.component + 1},
      {"understanding", name_of(audit.understanding)},
      {"probability", audit.level.probability},
      {"level", {{"mean", audit.level.mean}, {"low", audit.level.low}, {"high", audit.level.high}}},
      {"periods", audit.periods},
      {"tests", audit.tests},
      {"correct", audit.correct},
      {"misconception", audit.misconception ? misconception_json(atlas, *audit.misconception) : Json{}},
      {"test", demo_json(atlas, audit.test)},
      {"test_after",
       audit.understanding == Understanding::kUnderstands && audit.test_after > 0 ? Json(audit.test_after) : Json{}},
      {"advice", advice.empty() ? Json{} : Json(advice)}};
}

}  // namespace

std::string title_of(const AuditedPerson& person) {
  std::string who;
  if (person.seat != 0) who = fmt::format(", {} in seat {}", person.simulated ? "simulated," : "a person", person.seat);
  return fmt::format("Member {} ({}{})", person.member, person.type, who);
}

Json audit_json(const Atlas& atlas, const AuditReport& report, const std::string& program) {
  Json components = Json::array();
  for (std::size_t k = 0; k < atlas.knowledge_components().size(); ++k) {
    const auto counts = counts_of(report, k);
    components.push_back({{"number", k + 1},
                          {"name", component_in_words(atlas, k)},
                          {"understand", counts.understand},
                          {"cannot_tell", counts.cannot_tell},
                          {"misconception", counts.misconception},
                          {"not_taught", counts.not_taught}});
  }
  Json shared = Json::array();
  for (const auto& one : shared_misconceptions(report)) {
    shared.push_back(
        {{"component", one.component + 1}, {"fact", one.fact}, {"thinks", one.thinks}, {"people", one.people}});
  }
  Json people = Json::array();
  for (const auto& person : report.people) {
    Json audits = Json::array();
    for (const auto& audit : person.components) audits.push_back(component_json(atlas, audit));
    people.push_back({{"group", person.group},
                      {"team", person.team == 0 ? Json{} : Json(person.team)},
                      {"room", person.room.empty() ? Json{} : Json(person.room)},
                      {"member", person.member},
                      {"seat", person.seat == 0 ? Json{} : Json(person.seat)},
                      {"type", std::string(1, person.type)},
                      {"simulated", person.simulated},
                      {"components", std::move(audits)}});
  }
  const auto& options = report.options;
  return {{"schema", "kith.audit/1"},
          {"program", program},
          {"source", report.source},
          {"domain", board_domain_json(atlas.domain())},
          {"enough", options.level.enough},
          {"sure", options.sure},
          {"coverage", options.level.coverage},
          {"forgetting", options.forgetting},
          {"components", std::move(components)},
          {"misconceptions", std::move(shared)},
          {"people", std::move(people)}};
}

}  // namespace kith
