#include "read_study_spec.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string_view>

#include "kith/core/error.hpp"
#include "kith/random/stream.hpp"
#include "read_prior.hpp"

namespace kith {
namespace {

constexpr std::int64_t kMaxParticles = 1'000'000;
constexpr std::int64_t kMaxTeamSize = 30;

std::string in_quotes(std::string_view word) { return std::string{"'"}.append(word).append("'"); }

template <typename Target, typename Value>
void set_if(Target& target, const std::optional<Value>& value) {
  if (value) target = static_cast<Target>(*value);
}

class SpecReader {
 public:
  SpecReader(const TomlDocument& document, const Domain* domain, TomlReport& report)
      : root_{document.root, TomlPlace{}, "the study file", report}, domain_{domain}, report_{report} {}

  StudySpec read() {
    if (domain_ != nullptr) {
      spec_.num_features = domain_->num_features();
      spec_.count_scale = domain_->count_scale();
    }
    read_top();
    read_learner_types();
    if (auto design = root_.table("design", Presence::kRequired)) read_design(*design);
    if (auto teacher = root_.table("teacher", Presence::kOptional)) read_teacher(*teacher);
    if (auto stop = root_.table("stop", Presence::kOptional)) read_stop(*stop);
    if (auto record = root_.table("record", Presence::kOptional)) read_record(*record);
    if (auto group = root_.table("group", Presence::kOptional)) read_group(*group);
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
                      "one team per cell shows nothing about spread");
    }
  }

  // --- design ----------------------------------------------------------------

  void read_design(TomlReader& design) {
    read_strategies(design);
    read_compositions(design);
    if (const auto pairing = design.word("pairing", Presence::kOptional, kPairingWords)) {
      spec_.pairing = *pairing == 0 ? Pairing::kReplicate : Pairing::kNone;
    }
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

  void read_strategies(TomlReader& design) {
    const auto* list = word_list(design, "strategies");
    if (list == nullptr) return;
    std::vector<std::string> names;
    for (const auto& kind : strategy_kinds()) names.emplace_back(kind.name);
    for (const auto& element : *list) {
      const auto& name = *element.string();
      const auto* kind = find_strategy_kind(name);
      if (kind == nullptr) {
        report_.error("E0402", element.place(), "there is no strategy '" + name + "'", suggestion(name, names));
      } else if (std::any_of(spec_.strategies.begin(), spec_.strategies.end(),
                             [&](const auto& other) { return other.name == name; })) {
        report_.error("E0403", element.place(), "strategy '" + name + "' is listed twice");
      } else {
        spec_.strategies.push_back(strategy_named(name));
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
      std::string list;
      for (const auto& name : known) list += (list.empty() ? "" : ", ") + name;
      report_.error("E0405", report_.document().inside(element, i), "there is no learner type '" + letter + "'",
                    (list.empty() ? "" : "declared: " + list + "; ") + "add a table [learner." + letter + "]");
    }
  }

  // --- learners --------------------------------------------------------------

  void read_learner_types() {
    auto learners = root_.table("learner", Presence::kRequired);
    if (!learners) return;
    for (const auto& entry : learners->content().entries()) {
      const char letter = entry.key.empty() ? '?' : entry.key.front();
      const bool is_letter = (letter >= 'A' && letter <= 'Z') || (letter >= 'a' && letter <= 'z');
      learners->know(entry.key);
      if (entry.key.size() != 1 || !is_letter) {
        report_.error("E0406", entry.place, "learner type '" + entry.key + "' is not one letter",
                      "a composition such as \"NNP\" has one letter per member");
        continue;
      }
      if (auto table = learners->table(entry.key, Presence::kRequired)) {
        spec_.learner_types.push_back(read_learner_type(*table, letter));
      }
    }
  }

  [[nodiscard]] LearnerType read_learner_type(TomlReader& table, char letter) {
    LearnerType type;
    type.letter = letter;
    auto& population = type.population;
    population.label = std::string{letter};
    const auto errors = report_.num_errors();
    set_if(population.label, table.string("label", Presence::kOptional));
    set_if(population.ability_max, table.real("ability_max", Presence::kOptional, {0.5, 1.0, true, true}));
    if (auto ability = table.table("ability", Presence::kRequired)) read_ability(*ability, population);
    read_gain(table, "confirm_gain", population.confirm_gain);
    read_gain(table, "correct_gain", population.correct_gain);
    set_if(population.gain_max, table.real("gain_max", Presence::kOptional, {0.0, 0.5, true, false}));
    set_if(population.ordered_gains, table.boolean("ordered_gains", Presence::kOptional));
    set_if(population.ability_scale, table.real("ability_scale", Presence::kOptional, {0.0, 5.0, true, false}));
    set_if(type.filter.particles, table.integer("particles", Presence::kOptional, {1, kMaxParticles}));
    set_if(type.filter.process_noise, table.real("process_noise", Presence::kOptional, {0.0, 10.0}));
    if (const auto* prior = table.array("prior", Presence::kOptional)) {
      type.prior = read_prior(*prior, table.value("prior", Presence::kOptional)->place(), domain_, report_);
    }
    table.finish();
    if (report_.num_errors() == errors) check_that_people_exist(table, population);
    return type;
  }

  void read_ability(TomlReader& ability, Population& population) {
    set_if(population.ability_mean, ability.real("mean", Presence::kRequired, {0.0, 1.0}));
    set_if(population.ability_sd, ability.real("sd", Presence::kRequired, {0.0, 1.0}));
    set_if(population.ability_min, ability.real("min", Presence::kOptional, {0.5, 1.0, false, true}));
    if (population.ability_min >= population.ability_max) {
      report_.error("E0408", ability.place(), "no ability lies between min and ability_max",
                    "ability.min must be less than ability_max");
    }
    ability.finish();
  }

  void read_gain(TomlReader& table, std::string_view key, GainDistribution& gain) {
    auto reader = table.table(key, Presence::kRequired);
    if (!reader) return;
    gain = {};
    gain.half_normal = reader->real("half_normal", Presence::kOptional, {0.0, 1.0});
    gain.value = reader->real("value", Presence::kOptional, {0.0, 1.0});
    reader->finish();
    if (reader->has("half_normal") == reader->has("value")) {
      report_.error("E0407", reader->place(), in_quotes(key) + " needs either half_normal or value",
                    "write " + std::string{key} + " = { half_normal = 0.05 } or { value = 0.05 }");
    }
  }

  // Draws a few: limits that nobody, or hardly anybody, meets are found here and not in the middle of a study.
  void check_that_people_exist(TomlReader& table, const Population& population) {
    constexpr std::uint64_t kTries = 20;
    try {
      const RandomStream random{0};
      for (std::uint64_t i = 0; i < kTries; ++i) (void)draw_learner(population, random.split(i));
    } catch (const Error&) {
      report_.infeasible("E0409", table.place(), "hardly any learner meets the limits of " + table.name(),
                         "gains must be below gain_max and, unless ordered_gains = false, confirm_gain below "
                         "correct_gain; abilities between ability.min and ability_max");
    }
  }

  // --- the rest --------------------------------------------------------------

  void read_teacher(TomlReader& teacher) {
    auto& options = spec_.teaching;
    set_if(options.filter.particles, teacher.integer("particles", Presence::kOptional, {1, kMaxParticles}));
    set_if(options.filter.process_noise, teacher.real("process_noise", Presence::kOptional, {0.0, 10.0}));
    set_if(options.filter.resample_below, teacher.real("resample_below", Presence::kOptional, {0.0, 1.0}));
    set_if(options.counterfactuals, teacher.integer("counterfactuals", Presence::kOptional, {1, 100'000}));
    set_if(options.sampling, teacher.word("counterfactual_sampling", Presence::kOptional, kSamplingWords));
    set_if(options.assumed_ability, teacher.real("assumed_ability", Presence::kOptional, {0.5, 1.0, false, true}));
    set_if(options.likelihood, teacher.word("likelihood", Presence::kOptional, kLikelihoodWords));
    set_if(options.response_noise, teacher.real("response_noise", Presence::kOptional, {0.0, std::numbers::pi}));
    (void)teacher.word("conflict", Presence::kOptional, {kConflictRule});
    set_if(options.reduce_before_update, teacher.boolean("reduce_before_update", Presence::kOptional));
    if (const auto whose = teacher.word("learner_counterfactuals", Presence::kOptional, kCounterfactualWords)) {
      spec_.learner_counterfactuals_self = *whose == 1;
    }
    teacher.finish();
  }

  void read_stop(TomlReader& stop) {
    auto& options = spec_.teaching;
    set_if(options.max_periods, stop.integer("max_periods", Presence::kOptional, {1, 100'000}));
    set_if(options.consecutive_correct, stop.integer("consecutive_correct", Presence::kOptional, {1, 1000}));
    set_if(options.duplicate_sets, stop.integer("duplicate_sets", Presence::kOptional, {1, 1000}));
    stop.finish();
  }

  void read_record(TomlReader& record) {
    set_if(spec_.record, record.word("level", Presence::kOptional, kRecordWords));
    record.finish();
  }

  // Only sessions with people use it; here it is checked.
  void read_group(TomlReader& group) {
    (void)group.integer("size", Presence::kOptional, {1, kMaxTeamSize});
    (void)group.string("consent", Presence::kOptional);
    (void)group.string("questions", Presence::kOptional);
    if (auto dropout = group.table("dropout", Presence::kOptional)) {
      (void)dropout->word("policy", Presence::kOptional,
                          {"pause-then-continue", "continue-now", "replace-from-pool", "simulate", "end-group"});
      (void)dropout->integer("grace_s", Presence::kOptional, {0, 86'400});
      (void)dropout->integer("min_active", Presence::kOptional, {1, kMaxTeamSize});
      dropout->finish();
    }
    group.finish();
  }

  TomlReader root_;
  const Domain* domain_;
  TomlReport& report_;
  StudySpec spec_;
};

}  // namespace

StudySpec read_study_spec(const TomlDocument& document, const Domain* domain, TomlReport& report) {
  return SpecReader{document, domain, report}.read();
}

}  // namespace kith
