#include "kith/explain/audit_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "kith/explain/board_json.hpp"
#include "kith/explain/curriculum.hpp"
#include "kith/explain/words.hpp"

namespace kith {

AuditCounts counts_of(const AuditReport& report, std::size_t component) {
  AuditCounts counts;
  for (const auto& person : report.people) {
    switch (person.audit.components.at(component).understanding) {
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

Agreement agreement_of(const AuditReport& report, const std::string& group) {
  Agreement sum;
  std::size_t people = 0;
  for (const auto& person : report.people) {
    if (!group.empty() && person.group != group) continue;
    const auto& one = person.audit.agreement;
    people += one.tests > 0 ? 1u : 0u;
    if (one.tests > 0) sum.p = one.p;
    sum.tests += one.tests;
    sum.right += one.right;
    sum.expected += one.expected;
    sum.variance += one.variance;
  }
  if (people < 2) return sum;  // one person's is exact
  sum.p = 1.0;
  if (!(sum.variance > 0.0)) return sum;
  constexpr double kHalf = 0.5;  // numbers are whole
  const double off = std::max(0.0, std::abs(static_cast<double>(sum.right) - sum.expected) - kHalf);
  sum.p = std::erfc(off / std::sqrt(2.0 * sum.variance));
  return sum;
}

std::size_t num_unexplained(const AuditReport& report, const std::string& group) {
  return static_cast<std::size_t>(std::count_if(report.people.begin(), report.people.end(), [&](const auto& person) {
    return (group.empty() || person.group == group) && !person.audit.is_explained;
  }));
}

namespace {

// "16 of 20 are right, 15.2 were expected (p = 0.62)".
std::string counts_in_words(const Agreement& agreement) {
  constexpr double kSmallest = 0.001;
  return fmt::format("{} of {} {} right, {:.1f} {} expected (p {})", agreement.right,
                     counted(agreement.tests, "answer"), agreement.right == 1 ? "is" : "are", agreement.expected,
                     agreement.expected == 1.0 ? "was" : "were",
                     agreement.p < kSmallest ? "< 0.001" : fmt::format("= {:.2g}", agreement.p));
}

}  // namespace

std::string agreement_in_words(const AuditReport& report, const std::string& group) {
  const auto agreement = agreement_of(report, group);
  if (agreement.tests == 0) return "Nobody has answered a test.";
  const bool fits = agreement.p >= report.options.unexplained;
  const bool fewer = static_cast<double>(agreement.right) < agreement.expected;
  auto text = fits    ? std::string{"The answers fit what the model expects: "}
              : fewer ? std::string{"There are fewer right answers than the model expects: "}
                      : std::string{"There are more right answers than the model expects: "};
  text += counts_in_words(agreement) + ".";
  if (const auto n = num_unexplained(report, group); n > 0 && report.people.size() > 1) {
    text += fmt::format(" The model does not explain the answers of {}.",
                        n == 1 ? "1 person" : fmt::format("{} people", n));
  }
  return text;
}

std::string caution_in_words(const PersonAudit& audit) {
  constexpr double kLikely = 0.5;
  if (!audit.is_explained) {
    return "The model does not explain these answers: " + counts_in_words(audit.agreement) +
           ". The verdicts go by the number of right answers alone.";
  }
  if (audit.guessing >= kLikely) {
    return fmt::format("The answers look like guesses (probability {:.0f} %).", 100.0 * audit.guessing);
  }
  if (1.0 - audit.learning >= kLikely) {
    return fmt::format("Lessons do not seem to reach this person any more (probability {:.0f} %).",
                       100.0 * (1.0 - audit.learning));
  }
  return "";
}

std::string older_in_words(const PersonAudit& audit) {
  if (!audit.believes_older) return "";
  return fmt::format("still believes in the robot as it was before the update with probability {:.0f} %",
                     100.0 * *audit.believes_older);
}

std::string older_in_words(const AuditReport& report) {
  constexpr double kLikely = 0.5;
  if (!report.options.bank.known) return "";
  std::vector<std::string> who;
  for (const auto& person : report.people) {
    if (person.audit.believes_older.value_or(0.0) >= kLikely) who.push_back(person.group + ": " + title_of(person));
  }
  std::string text = who.empty() ? "Nobody seems to believe" : "These people still seem to believe";
  text += " in the robot as it was before the update";
  for (std::size_t i = 0; i < who.size(); ++i) text += (i == 0 ? ": " : "; ") + who[i];
  return text + ".";
}

std::string need_in_words(const PersonAudit& audit) {
  constexpr double kLikely = 0.5;
  constexpr std::size_t kSeveral = 2;  // lessons; after the first one, misconceptions are common
  if (audit.agreement.tests == 0) return "";
  if (!audit.is_explained) {
    const bool fewer = static_cast<double>(audit.agreement.right) < audit.agreement.expected;
    return fewer ? "far fewer right answers than expected" : "";
  }
  if (audit.guessing >= kLikely) return "the answers look like guesses";
  if (1.0 - audit.learning >= kLikely) return "lessons do not seem to reach this person";
  for (const auto& one : audit.components) {
    if (one.understanding == Understanding::kMisconception && one.periods >= kSeveral) {
      return fmt::format("after {} lessons still thinks that {}", one.periods, one.misconception->thinks);
    }
  }
  return "";
}

std::vector<SharedMisconception> shared_misconceptions(const AuditReport& report) {
  struct Group {
    std::size_t people = 0;
    std::map<std::string, std::size_t> thinks;
  };
  std::map<std::pair<std::size_t, std::string>, Group> groups;  // by component and fact
  for (const auto& person : report.people) {
    for (const auto& audit : person.audit.components) {
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

namespace {

// Why nothing can be told.
std::string doubt_in_words(Doubt doubt) {
  if (doubt == Doubt::kNone) return "";
  if (doubt == Doubt::kAnswers) return "the answers do not decide it";
  return std::string{"somebody who "} +
         (doubt == Doubt::kLearning ? "guesses or learns nothing" : "has stopped learning") + " might answer like this";
}

}  // namespace

std::string verdict_in_words(const ComponentAudit& audit) {
  const auto doubt = doubt_in_words(audit.doubt);
  return in_words(audit.understanding) + (doubt.empty() ? "" : ": " + doubt);
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

Json start_json(const Atlas& atlas, std::optional<StartIndex> start, bool has_path) {
  if (!start) return nullptr;
  auto json = board_json(atlas.domain(), atlas.id(*start));
  if (has_path) json.update(path_json(atlas.domain(), atlas.id(*start).mdp, atlas.trajectory(*start)));
  json["mdp"] = atlas.id(*start).mdp.value();
  json["start_state"] = atlas.id(*start).start.value();
  return json;
}

Json misconception_json(const Atlas& atlas, const LikelyMisconception& misconception) {
  const auto& domain = atlas.domain();
  Json answers = Json::array();
  for (const auto& answer : misconception.answers) {
    const auto id = atlas.id(answer.start);
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
          {"show", start_json(atlas, misconception.show, true)},
          {"reason", misconception.reason.empty() ? Json{} : Json(misconception.reason)}};
}

// The name of the folder, without where it is on this machine.
std::string name_of_folder(const std::string& source) {
  auto path = std::filesystem::path{source}.lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  const auto name = path.filename().string();
  return name.empty() || name == "." || name == ".." ? "this study" : name;
}

Json agreement_json(const Agreement& agreement) {
  return {{"tests", agreement.tests},
          {"right", agreement.right},
          {"expected", agreement.expected},
          {"p", agreement.tests > 0 ? Json(agreement.p) : Json{}}};
}

Json component_json(const Atlas& atlas, const ComponentAudit& audit) {
  const auto advice = advice_in_words(audit);
  return {
      {"component", audit.component + 1},
      {"understanding", name_of(audit.understanding)},
      {"verdict", in_words(audit.understanding)},
      {"doubt", audit.doubt == Doubt::kNone ? Json{} : Json(doubt_in_words(audit.doubt))},
      {"probability", audit.level.probability},
      {"level", {{"mean", audit.level.mean}, {"low", audit.level.low}, {"high", audit.level.high}}},
      {"periods", audit.periods},
      {"tests", audit.tests},
      {"correct", audit.correct},
      {"misconception", audit.misconception ? misconception_json(atlas, *audit.misconception) : Json{}},
      {"test", start_json(atlas, audit.test, false)},
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
  for (const auto& misconception : shared_misconceptions(report)) {
    shared.push_back({{"component", misconception.component + 1},
                      {"fact", misconception.fact},
                      {"thinks", misconception.thinks},
                      {"people", misconception.people}});
  }

  Json people = Json::array();
  for (const auto& person : report.people) {
    Json audits = Json::array();
    for (const auto& audit : person.audit.components) audits.push_back(component_json(atlas, audit));
    const auto caution = caution_in_words(person.audit);
    people.push_back({{"title", title_of(person)},
                      {"group", person.group},
                      {"team", person.team == 0 ? Json{} : Json(person.team)},
                      {"room", person.room.empty() ? Json{} : Json(person.room)},
                      {"member", person.member},
                      {"seat", person.seat == 0 ? Json{} : Json(person.seat)},
                      {"type", std::string(1, person.type)},
                      {"simulated", person.simulated},
                      {"agreement", agreement_json(person.audit.agreement)},
                      {"knows", person.audit.knowledge() ? Json(*person.audit.knowledge()) : Json{}},
                      {"explained", person.audit.is_explained},
                      {"learning", person.audit.learning},
                      {"guessing", person.audit.guessing},
                      {"caution", caution.empty() ? Json{} : Json(caution)},
                      {"components", std::move(audits)}});
    if (person.audit.believes_older) people.back()["believes_older"] = *person.audit.believes_older;
    if (person.kinds.empty()) continue;
    people.back()["kind"] = kind_word(person.kinds);
    for (const auto& [kind, probability] : person.kinds) people.back()["kinds"][kind] = probability;
  }

  // People of a group stand together.
  Json groups = Json::array();
  std::string last;
  for (const auto& person : report.people) {
    if (person.group == last) continue;
    last = person.group;
    groups.push_back({{"group", last},
                      {"agreement", agreement_json(agreement_of(report, last))},
                      {"says", agreement_in_words(report, last)},
                      {"unexplained", num_unexplained(report, last)}});
  }

  const auto& options = report.options;
  const auto older = older_in_words(report);
  return {{"schema", "kith.audit/1"},
          {"title", "Who understands what: " + name_of_folder(report.source)},
          {"name", name_of_folder(report.source)},
          {"program", program},
          {"source", report.source},
          {"domain", board_domain_json(atlas.domain())},
          {"enough", options.level.enough},
          {"sure", options.sure},
          {"coverage", options.level.coverage},
          {"forgetting", options.forgetting},
          {"agreement", agreement_json(agreement_of(report))},
          {"says", agreement_in_words(report) + (older.empty() ? "" : " " + older)},
          {"unexplained", num_unexplained(report)},
          {"groups", std::move(groups)},
          {"components", std::move(components)},
          {"misconceptions", std::move(shared)},
          {"people", std::move(people)}};
}

}  // namespace kith
