#include <algorithm>
#include <cmath>

#include "kith/core/error.hpp"
#include "kith/core/stream.hpp"
#include "parameters_toml.hpp"
#include "read_study_spec.hpp"

namespace kith {
namespace {

class LearnerTypesReader {
 public:
  LearnerTypesReader(const Domain* domain, const StudyKinds& kinds, TomlReport& report)
      : domain_{domain}, kinds_{kinds}, report_{report} {}

  std::vector<LearnerType> read(TomlReader& root) {
    auto learners = root.table("learner", Presence::kRequired);
    if (!learners) return {};
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
        types_.push_back(table->has("mixture") ? read_mixed_type(*table, letter) : read_learner_type(*table, letter));
      }
    }
    for (const auto& type : types_) check_mixture(type, *learners);
    return std::move(types_);
  }

 private:
  // [learner.X] mixture = { N = 0.7, S = 0.3 }
  [[nodiscard]] LearnerType read_mixed_type(TomlReader& table, char letter) {
    LearnerType type;
    type.letter = letter;
    type.label = std::string{letter};
    set_if(type.label, table.string("label", Presence::kOptional));
    type.model = kinds_.learners.front();
    type.parameters = ParameterValues{type.model->parameters};
    if (auto shares = table.table("mixture", Presence::kRequired)) {
      for (const auto& entry : shares->content().entries()) {
        const auto share = shares->real(entry.key, Presence::kRequired, {0.0, 1.0, true, false});
        if (entry.key.size() == 1 && share) {
          type.mixture.push_back({entry.key.front(), *share});
        } else if (entry.key.size() != 1) {
          report_.error("E0423", entry.place, "'" + entry.key + "' is not the letter of a learner type");
        }
      }
    }
    table.finish();
    return type;
  }

  void check_mixture(const LearnerType& type, TomlReader& learners) {
    const auto* table = learners.content().find(std::string{type.letter})->table();
    const auto* shares = table != nullptr ? table->find("mixture") : nullptr;
    if (shares == nullptr || shares->table() == nullptr) return;
    double sum = 0.0;
    for (const auto& [letter, share] : type.mixture) {
      sum += share;
      const auto part = std::find_if(types_.begin(), types_.end(),
                                     [&, wanted = letter](const auto& other) { return other.letter == wanted; });
      if (part != types_.end() && part->mixture.empty()) continue;
      report_.error("E0423", shares->table()->find_entry(std::string{letter})->place,
                    part == types_.end() ? std::string{"there is no learner type '"} + letter + "'"
                                         : std::string{"learner type '"} + letter + "' is a mixture itself",
                    "add a table [learner." + std::string{letter} + "] with a kind");
    }
    constexpr double kRounding = 1e-9;
    if (std::abs(sum - 1.0) <= kRounding || report_.num_errors() > 0) return;
    report_.error("E0423", shares->place(), "the shares of this mixture sum to " + to_string(ParameterValue{sum}),
                  "shares must sum to 1");
  }

  [[nodiscard]] LearnerType read_learner_type(TomlReader& table, char letter) {
    LearnerType type;
    type.letter = letter;
    type.label = std::string{letter};
    const auto errors = report_.num_errors();
    set_if(type.label, table.string("label", Presence::kOptional));
    type.model = read_kind(table);
    if (type.model == nullptr) {  // then it is not known which keys there are
      type.model = kinds_.learners.front();
      return type;
    }
    type.parameters = read_parameters(table, type.model->parameters);
    if (const auto* prior = table.array("prior", Presence::kOptional)) {
      type.prior = read_prior(*prior, table.value("prior", Presence::kOptional)->place(), domain_, report_);
    }
    type.knowing = read_knowing(table, domain_, report_);
    table.finish();
    if (report_.num_errors() == errors) check_knowing(table, type, domain_, report_);
    if (report_.num_errors() == errors) check_parameters(table, type);
    if (report_.num_errors() == errors) check_that_people_exist(table, type);
    return type;
  }

  // Null after reporting that there is no such kind.
  [[nodiscard]] const LearnerModel* read_kind(TomlReader& table) {
    const auto kind = table.string("kind", Presence::kOptional);
    if (!kind) return table.has("kind") ? nullptr : kinds_.learners.front();
    const auto* model = find_learner_model(*kind, kinds_.learners);
    if (model == nullptr) {
      std::vector<std::string> kinds;
      for (const auto* known : kinds_.learners) kinds.emplace_back(known->kind);
      report_.error("E0417", table.value("kind", Presence::kOptional)->place(),
                    "there is no learner model '" + *kind + "'", suggestion(*kind, kinds));
    }
    return model;
  }

  void check_parameters(TomlReader& table, const LearnerType& type) {
    if (type.model->check == nullptr) return;
    if (const auto problem = type.model->check(type.parameters)) {
      report_.error("E0408", place_of(problem->where, table), problem->message, problem->hint);
    }
  }

  // Draws a few: limits that nobody, or hardly anybody, meets are found here and not in the middle of a study.
  void check_that_people_exist(TomlReader& table, const LearnerType& type) {
    constexpr std::uint64_t kTries = 20;
    try {
      const RandomStream random{0};
      for (std::uint64_t i = 0; i < kTries; ++i) (void)type.model->draw(type.parameters, random.split(i));
    } catch (const Error& error) {
      report_.infeasible("E0409", table.place(), "hardly any drawn learner satisfies the limits of " + table.name(),
                         error.what());
    }
  }

  const Domain* domain_;
  const StudyKinds& kinds_;
  TomlReport& report_;
  std::vector<LearnerType> types_;
};

}  // namespace

std::vector<LearnerType> read_learner_types(TomlReader& study, const Domain* domain, const StudyKinds& kinds,
                                            TomlReport& report) {
  return LearnerTypesReader{domain, kinds, report}.read(study);
}

}  // namespace kith
