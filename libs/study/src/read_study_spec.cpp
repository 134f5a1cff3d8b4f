#include "read_study_spec.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "kith/core/text.hpp"
#include "kith/learners/presumed_kinds.hpp"
#include "kith/study/outcomes.hpp"
#include "parameters_toml.hpp"
#include "study_keys.hpp"

namespace kith {
namespace {

constexpr std::int64_t kMaxTeamSize = 30;

class SpecReader {
 public:
  SpecReader(const TomlDocument& document, const Domain* domain, const StudyKinds& kinds, TomlReport& report)
      : root_{document.root, TomlPlace{}, "the study file", report}, domain_{domain}, kinds_{kinds}, report_{report} {}

  StudySpec read() {
    if (domain_ != nullptr) {
      take_domain(spec_, *domain_);
      // The mass in the policy's class is 0 for everybody there.
      if (exam_leads(true, spec_.num_features)) spec_.exam = ExamLevel::kEnd;
    }
    read_top();
    spec_.learner_types = read_learner_types(root_, domain_, kinds_, report_);
    read_strategy_tables();
    const auto num_errors = report_.num_errors();
    if (auto design = root_.table("design", Presence::kRequired)) read_design(*design);
    const bool is_design_good = report_.num_errors() == num_errors;  // else every contrast of it would be wrong, too
    if (auto teacher = root_.table("teacher", Presence::kOptional)) read_teacher(*teacher);
    if (!report_.has_errors()) presume_knowing(root_, spec_, domain_, report_);
    if (auto stop = root_.table("stop", Presence::kOptional)) read_stop(*stop);
    if (auto pace = root_.table("pace", Presence::kOptional)) read_all(*pace, pace_keys());
    if (auto record = root_.table("record", Presence::kOptional)) read_all(*record, record_keys());
    if (auto group = root_.table("group", Presence::kOptional)) read_group_table(*group);
    if (const auto* contrasts = root_.array("contrast", Presence::kOptional); contrasts != nullptr && is_design_good) {
      spec_.contrasts = read_contrasts(*contrasts, spec_, report_);
    }
    root_.finish();
    return std::move(spec_);
  }

 private:
  void read_top() {
    (void)root_.string("schema", Presence::kRequired);  // which one it is was checked before
    if (const auto id = root_.string("id", Presence::kRequired)) {
      spec_.id = *id;
      const bool plain = !id->empty() && std::all_of(id->begin(), id->end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
      });
      if (!plain) {
        report_.error("E0115", root_.value("id", Presence::kOptional)->place(), "id '" + *id + "' cannot be a name",
                      "use lower-case letters, digits and '-'");
      }
    }
    set_if(spec_.title, root_.string("title", Presence::kOptional));
    set_if(spec_.domain, root_.string("domain", Presence::kRequired));
    set_if(spec_.seed, root_.integer("seed", Presence::kRequired, {.min = 0}));
    set_if(spec_.replicates, root_.integer("replicates", Presence::kOptional, {.min = 1, .max = 10'000'000}));
    if (spec_.replicates == 1) {
      const auto* value = root_.value("replicates", Presence::kOptional);
      report_.warning("W0402", value != nullptr ? value->place() : TomlPlace{},
                      "with one team per cell, variance cannot be estimated");
    }
  }

  // --- design ----------------------------------------------------------------

  void read_design(TomlReader& design) {
    read_strategies(design);
    read_compositions(design);
    static const std::array pairing{option_key<StudySpec, &StudySpec::pairing>("pairing", "")};
    read_options(design, std::span<const OptionKey<StudySpec>>{pairing}, spec_);
    design.know("vary");
    design.finish();
  }

  // The elements of a list of strings; an empty list is an error.
  [[nodiscard]] const TomlArray* word_list(TomlReader& table, std::string_view key) {
    const auto* list = table.array(key, Presence::kRequired);
    if (list == nullptr || !table.strings(key, Presence::kRequired)) return nullptr;
    if (list->empty()) {
      report_.error("E0401", table.value(key, Presence::kOptional)->place(), in_quotes(key) + " is empty");
    }
    return list;
  }

  // Strategies with parameters of their own: [strategy.NAME] with a kind, unless NAME is one.
  void read_strategy_tables() {
    auto tables = root_.table("strategy", Presence::kOptional);
    if (!tables) return;
    std::vector<std::string> kinds;
    for (const auto& kind : kinds_.strategies) kinds.emplace_back(kind.name);
    for (const auto& entry : tables->content().entries()) {
      tables->know(entry.key);
      auto table = tables->table(entry.key, Presence::kRequired);
      if (!table) continue;
      const bool is_kind = find_strategy_kind(entry.key, kinds_.strategies) != nullptr;
      const auto word = table->word("kind", is_kind ? Presence::kOptional : Presence::kRequired, kinds);
      if (!is_kind && !word) continue;
      const auto* kind = find_strategy_kind(word ? kinds[*word] : entry.key, kinds_.strategies);
      if (kind->name == kBaseline && entry.key != kBaseline) {
        report_.error("E0418", entry.place, "strategy '" + entry.key + "' cannot be of the kind 'baseline'",
                      "list \"baseline\" itself in design.strategies");
      }
      for (const auto* gone : {"expected_gain", "min_gain"}) {
        const auto* value = kind->name == "plan" ? table->value(gone, Presence::kOptional) : nullptr;
        if (value == nullptr) continue;
        report_.warning("W0407", value->place(), in_quotes(gone) + " is no longer there and has no effect",
                        "delete it: what people gain is a hypothesis, and a lesson is as long as it pays");
      }
      own_strategies_.push_back({entry.key, *kind, read_parameters(*table, kind->parameters)});
      own_places_.push_back(entry.place);
      table->finish();
    }
  }

  [[nodiscard]] std::optional<StrategyChoice> strategy_called(const std::string& name) const {
    const auto own =
        std::find_if(own_strategies_.begin(), own_strategies_.end(), [&](const auto& one) { return one.name == name; });
    if (own != own_strategies_.end()) return *own;
    if (find_strategy_kind(name, kinds_.strategies) == nullptr) return std::nullopt;
    return strategy_named(name, kinds_.strategies);
  }

  void read_strategies(TomlReader& design) {
    const auto* list = word_list(design, "strategies");
    if (list == nullptr) return;
    std::vector<std::string> names;
    for (const auto& kind : kinds_.strategies) names.emplace_back(kind.name);
    for (const auto& own : own_strategies_) {
      if (std::find(names.begin(), names.end(), own.name) == names.end()) names.push_back(own.name);
    }
    for (const auto& element : *list) {
      auto name = *element.string();
      if (name == "adaptive" && !strategy_called(name)) {
        report_.warning("W0408", element.place(), "strategy 'adaptive' is read as 'plan'",
                        "'plan' does what 'adaptive' did: it finds out from their answers how well people learn");
        name = "plan";
        if (is_listed(name)) continue;
      }
      auto strategy = strategy_called(name);
      if (!strategy) {
        report_.error("E0402", element.place(), "there is no strategy '" + name + "'", suggestion(name, names));
      } else if (is_listed(name)) {
        report_.error("E0403", element.place(), "strategy '" + name + "' is listed twice");
      } else {
        spec_.strategies.push_back(*std::move(strategy));
      }
    }
    for (std::size_t i = 0; i < own_strategies_.size(); ++i) {
      if (is_listed(own_strategies_[i].name)) continue;
      report_.warning("W0404", own_places_[i],
                      "strategy '" + own_strategies_[i].name + "' is not listed in design.strategies");
    }
  }

  [[nodiscard]] bool is_listed(const std::string& name) const {
    return std::any_of(spec_.strategies.begin(), spec_.strategies.end(),
                       [&](const auto& other) { return other.name == name; });
  }

  // What kinds of learners the hypotheses are about.
  void read_kinds(TomlReader& teacher) {
    const auto all = presumable_kinds(kinds_.learners);
    auto named = all;
    const auto* list = teacher.array("kinds", Presence::kOptional);
    if (list != nullptr && teacher.strings("kinds", Presence::kOptional)) {
      named.clear();
      for (const auto& element : *list) {
        const auto& name = *element.string();
        if (std::find(all.begin(), all.end(), name) == all.end()) {
          report_.error("E0424", element.place(),
                        "there is no kind of learner '" + name + "' that hypotheses can be about",
                        suggestion(name, all));
        } else if (std::find(named.begin(), named.end(), name) != named.end()) {
          report_.error("E0403", element.place(), "kind '" + name + "' is listed twice");
        } else {
          named.push_back(name);
        }
      }
      if (list->empty()) {
        report_.error("E0424", teacher.value("kinds", Presence::kOptional)->place(), "there is no kind in the list",
                      "leave it out for all kinds");
      }
      if (spec_.teaching.hypotheses_about != HypothesesAbout::kKinds) {
        report_.warning("W0405", teacher.value("kinds", Presence::kOptional)->place(),
                        "teacher.kinds means nothing without teacher.hypotheses = \"kinds\"");
      }
    }
    spec_.teaching.kinds = hypotheses_about_kinds(named, kinds_.learners);
  }

  // The rules of aggregation whose beliefs are kept.
  void read_beliefs(TomlReader& teacher) {
    auto& rules = spec_.teaching.rules;
    const auto* list = teacher.array("beliefs", Presence::kOptional);
    if (list == nullptr || !teacher.strings("beliefs", Presence::kOptional)) return;
    rules.clear();
    std::vector<std::string> names;
    for (const auto& rule : kinds_.rules) names.emplace_back(rule.name);
    for (const auto& element : *list) {
      const auto& name = *element.string();
      const auto rule =
          std::find_if(kinds_.rules.begin(), kinds_.rules.end(), [&](const auto& r) { return r.name == name; });
      if (rule == kinds_.rules.end()) {
        report_.error("E0419", element.place(), "there is no belief about a team called '" + name + "'",
                      suggestion(name, names));
      } else if (std::any_of(rules.begin(), rules.end(), [&](const auto& other) { return other.name == name; })) {
        report_.error("E0403", element.place(), "belief '" + name + "' is listed twice");
      } else {
        rules.push_back(*rule);
      }
    }
    for (const auto& strategy : spec_.strategies) {
      for (const auto& need : strategy.kind.needs(strategy.parameters).rules) {
        if (std::any_of(rules.begin(), rules.end(), [&](const auto& rule) { return rule.name == need; })) continue;
        report_.error("E0419", teacher.value("beliefs", Presence::kOptional)->place(),
                      "strategy '" + strategy.name + "' needs the belief '" + need + "'", "add it to the list");
      }
    }
  }

  void read_compositions(TomlReader& design) {
    const auto* list = word_list(design, "compositions");
    if (list == nullptr) return;
    std::set<char> used;
    std::set<std::string_view> listed;
    for (const auto& element : *list) {
      const auto& composition = *element.string();
      used.insert(composition.begin(), composition.end());
      if (composition.empty() || composition.size() > kMaxTeamSize) {
        report_.error("E0404", element.place(),
                      "a composition has 1 to " + std::to_string(kMaxTeamSize) + " letters, one per member");
      } else if (!listed.insert(composition).second) {
        report_.error("E0403", element.place(), "composition '" + composition + "' is listed twice");
      } else {
        check_letters(element, composition);
        spec_.compositions.push_back(composition);
      }
    }
    const auto* learners = root_.value("learner", Presence::kOptional);
    for (const auto& type : spec_.learner_types) {
      if (used.count(type.letter) == 0) continue;
      for (const auto& part : type.mixture) used.insert(part.letter);
    }
    for (const auto& type : spec_.learner_types) {
      if (used.count(type.letter) > 0) continue;
      const std::string name{type.letter};
      report_.warning("W0401", learners->table()->find_entry(name)->place,
                      "learner type '" + name + "' is in no composition");
    }
  }

  void check_letters(const TomlValue& element, const std::string& composition) {
    std::vector<std::string> known;
    for (const auto& type : spec_.learner_types) known.emplace_back(1, type.letter);
    for (std::size_t i = 0; i < composition.size(); ++i) {
      const std::string letter{composition[i]};
      if (std::count(known.begin(), known.end(), letter) > 0 || composition.find(composition[i]) < i) continue;
      const auto list = joined(known);
      report_.error("E0405", report_.document().inside(element, i), "there is no learner type '" + letter + "'",
                    (list.empty() ? "" : "declared: " + list + "; ") + "add a table [learner." + letter + "]");
    }
  }

  // --- the rest --------------------------------------------------------------

  // A key of versions before, whose only value was what is always done.
  void refuse_conflict(TomlReader& teacher) {
    const auto* value = teacher.content().find("conflict");
    if (value == nullptr) return;
    teacher.know("conflict");
    report_.error("E0107", value->place(),
                  "the key 'conflict' of [teacher] is no longer read: members whose answers conflict are always left "
                  "out of the common belief, as few as possible",
                  "remove this line; results do not change");
  }

  // Frozen studies of versions before say that the whole team is taught together, as it is now in any case.
  void refuse_grouping(TomlReader& teacher) {
    const auto* value = teacher.content().find("grouping");
    if (value == nullptr) return;
    const auto word = teacher.string("grouping", Presence::kRequired);
    if (!word || *word == "together") return;
    report_.error("E0107", value->place(),
                  "the key 'grouping' of [teacher] is no longer there; the whole team is taught together",
                  "remove this line, or give each learner type a composition of its own");
  }

  void read_teacher(TomlReader& teacher) {
    read_options(teacher, teacher_keys(), spec_.teaching);
    read_options(teacher, more_teacher_keys(), spec_);
    const auto knowing = teacher.word("knowing", Presence::kOptional, {"learners", "nothing"});
    spec_.assumes_knowing = knowing.value_or(0) == 0;
    refuse_conflict(teacher);
    refuse_grouping(teacher);
    static_cast<void>(teacher.integer("placement_tests", Presence::kOptional, {0, 0}));  // of earlier run folders
    read_beliefs(teacher);
    read_kinds(teacher);
    teacher.finish();
  }

  void read_stop(TomlReader& stop) {
    auto& options = spec_.teaching;
    read_options(stop, stop_keys(), options);
    std::vector<const StopRuleKind*> all, releasing;
    for (const auto& kind : kinds_.stop_rules) {
      all.push_back(&kind);
      if (kind.released != nullptr) releasing.push_back(&kind);
    }
    if (auto rule = read_stop_rule(stop, "mastery", {}, all)) options.mastery = *std::move(rule);
    options.release = read_stop_rule(stop, "release", {"none"}, releasing);
    stop.finish();
  }

  // Nothing if no kind is named.
  static std::optional<StopChoice> read_stop_rule(TomlReader& stop, std::string_view key,
                                                  std::vector<std::string> words,
                                                  const std::vector<const StopRuleKind*>& kinds) {
    const auto others = words.size();
    for (const auto* kind : kinds) words.emplace_back(kind->name);
    const auto word = stop.word(key, Presence::kOptional, words);
    if (!word || *word < others) return std::nullopt;
    const auto& kind = *kinds[*word - others];
    return StopChoice{kind, read_parameters(stop, kind.parameters)};
  }

  template <typename Keys>
  void read_all(TomlReader& table, const Keys& keys) {
    read_options(table, keys, spec_);
    table.finish();
  }

  void read_group_table(TomlReader& group) {
    spec_.has_group = true;
    spec_.group = read_group(group, report_);
    const auto& dropout = spec_.group.dropout;
    std::size_t largest = spec_.group.size;
    for (const auto& composition : spec_.compositions) largest = std::max(largest, composition.size());
    if (!spec_.compositions.empty() && dropout.min_active > largest) {
      report_.error("E0422", place_of_group_key(group, "dropout"),
                    "'min_active' is " + std::to_string(dropout.min_active) + ", but the largest group has " +
                        std::to_string(largest) + " seats: every session would end at once");
    }
    for (const char letter : spec_.group.high_types) {
      const bool is_used = std::any_of(spec_.compositions.begin(), spec_.compositions.end(),
                                       [&](const std::string& one) { return one.find(letter) != std::string::npos; });
      if (spec_.compositions.empty() || is_used) continue;
      report_.error("E0422", place_of_group_key(group, "screening"),
                    std::string{"'high' names the learner type '"} + letter + "', which is in no composition");
    }
    for (const auto seat : spec_.group.people) {
      if (spec_.compositions.empty() || seat <= largest) continue;
      report_.error(
          "E0422", place_of_group_key(group, "people"),
          "there is no seat " + std::to_string(seat) + ": the largest group has " + std::to_string(largest) + " seats");
    }
  }

  [[nodiscard]] static TomlPlace place_of_group_key(const TomlReader& group, std::string_view key) {
    const auto* value = group.content().find(key);
    return value != nullptr ? value->place() : group.place();
  }

  TomlReader root_;
  const Domain* domain_;
  StudyKinds kinds_;
  TomlReport& report_;
  StudySpec spec_;
  std::vector<StrategyChoice> own_strategies_;  // of [strategy.NAME]
  std::vector<TomlPlace> own_places_;
};

}  // namespace

StudySpec read_study_spec(const TomlDocument& document, const Domain* domain, const StudyKinds& kinds,
                          TomlReport& report) {
  return SpecReader{document, domain, kinds, report}.read();
}

}  // namespace kith
