#include "sections.hpp"

#include <algorithm>
#include <cctype>
#include <set>

#include "bibliography.hpp"
#include "built_in.hpp"
#include "kith/analysis/analysis.hpp"
#include "kith/explain/words.hpp"
#include "parameters.hpp"
#include "sentences.hpp"

namespace kith::detail {
namespace {

// Collects what is cited, in the order of first use.
class Citations {
 public:
  Citations() : references_{parse_bibtex(kReferencesText)} {}

  // "(Jayaraman et al., 2024)"; nothing for a key that references.bib does not have.
  std::string operator()(const std::string& key) {
    if (key.empty()) return "";
    const auto text = inside(key);
    return text.empty() ? "" : " (" + text + ")";
  }

  // The same without brackets.
  std::string inside(const std::string& key) {
    const auto found =
        std::find_if(references_.begin(), references_.end(), [&](const auto& one) { return one.key == key; });
    if (found == references_.end()) return "";
    if (cited_keys_.insert(key).second) {
      cited_.push_back({{"key", key}, {"text", reference_text(*found)}, {"bibtex", found->bibtex}});
    }
    return citation_text(*found);
  }

  [[nodiscard]] Json take() && { return std::move(cited_); }

 private:
  std::vector<Reference> references_;
  std::set<std::string> cited_keys_;
  Json cited_ = Json::array();
};

class Paragraph {
 public:
  Paragraph(const RunFiles& run, const ReportDesign& design, const RunData& data, const Analysis& analysis)
      : run_{run}, spec_{run.spec()}, design_{design}, data_{data}, analysis_{analysis} {}

  Json write() && {
    design();
    task();
    learners();
    beliefs();
    teaching();
    measures();
    statistics();
    return {{"paragraph", text_}, {"references", std::move(cite_).take()}};
  }

 private:
  void say(const std::string& sentence) { text_ += (text_.empty() ? "" : " ") + sentence; }

  [[nodiscard]] std::string program() const {
    auto text = "kith " + manifest_text(run_, "version");
    const auto git = manifest_text(run_, "git");
    if (!git.empty() && git != "unknown") text += " (" + git + ")";
    return text;
  }

  void design() {
    std::set<std::size_t> sizes;
    for (const auto& composition : spec_.compositions) sizes.insert(composition.size());
    std::string members = std::to_string(*sizes.begin());
    if (sizes.size() > 1) members += " to " + std::to_string(*sizes.rbegin());

    std::vector<std::string> names;
    std::string types;
    for (const auto& strategy : spec_.strategies) names.push_back(strategy.name);
    for (const auto& type : spec_.learner_types) {
      if (type.label.empty()) continue;
      types += (types.empty() ? "" : ", ") + std::string{type.letter} + ": " + type.label;
    }

    say("We simulated " + counted(data_.teams.size(), "team") + " of " + members +
        (sizes == std::set<std::size_t>{1} ? " learner" : " learners") + " with " + program() + " and random seed " +
        std::to_string(spec_.seed) + ".");
    for (const auto& before : run_.manifest.value("grown", std::vector<std::string>{}))
      say("Teams were added to a run that had " + before + ".");

    say("The design crossed " + how_many(names.size(), "teaching strategy", "teaching strategies") +
        cite_("jayaraman2024") + ", " + listed(names) + ", with " +
        counted(spec_.compositions.size(), "team composition") + ", " + listed(spec_.compositions) +
        (types.empty() ? "" : " (" + types + ")") + ", at " + counted(spec_.replicates, "team") + " per cell.");
    if (!spec_.factors.empty()) say(variation());
    say(spec_.pairing == Pairing::kReplicate
            ? "The same simulated people were taught with every strategy (common random numbers; " +
                  cite_.inside("salmon2011") + ")."
            : "Every cell had its own simulated people, drawn from counter-based random streams" + cite_("salmon2011") +
                  ".");
  }

  [[nodiscard]] std::string variation() const {
    std::vector<std::string> keys;
    for (std::size_t i = 0; i < spec_.factors.size(); ++i) {
      std::vector<std::string> values;
      for (const auto& variant : run_.study.variants) {
        const auto& value = variant.factors[i].value;
        if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
      }
      keys.push_back(spec_.factors[i].key + " (" + listed(values) + ")");
    }
    return "In addition we varied " + listed(keys) + ".";
  }

  void task() {
    std::vector<std::string> features;
    for (std::size_t k = 0; k < run_.domain.num_features(); ++k) {
      features.push_back(run_.domain.feature_names()[k] + " (" + shortest(run_.domain.weights().raw[k]) + ")");
    }
    say("The robot's policy was optimal for a reward that is linear in the features " + listed(features) +
        " of the domain " + run_.domain.id() + ", which has " + counted(run_.domain.num_mdps(), "world") + " with " +
        std::to_string(run_.domain.num_starts()) +
        " start states; lessons showed the robot's paths from some of them.");
    if (const auto explained = explained_in_words(run_.domain); !explained.empty())
      say("Nobody wrote the reward down: " + explained + ".");
  }

  [[nodiscard]] bool is_used(const LearnerType& type) const {
    const auto is_named = [&](char letter) {
      return std::any_of(spec_.compositions.begin(), spec_.compositions.end(),
                         [&](const auto& composition) { return composition.find(letter) != std::string::npos; });
    };
    return is_named(type.letter) ||
           std::any_of(spec_.learner_types.begin(), spec_.learner_types.end(), [&](const LearnerType& mixed) {
             return is_named(mixed.letter) &&
                    std::any_of(mixed.mixture.begin(), mixed.mixture.end(),
                                [&](const LearnerShare& part) { return part.letter == type.letter; });
           });
  }
  [[nodiscard]] static std::string name_of_type(const LearnerType& type) {
    return type.label.empty() ? std::string{type.letter} : type.label;
  }

  // What holds for every one of these learner types: said once where it is the same for all, else type by type.
  template <typename Words>
  [[nodiscard]] static std::string per_type(const std::vector<const LearnerType*>& types, Words words) {
    std::vector<std::string> each;
    std::set<std::string> different;
    for (const auto* type : types) {
      different.insert(words(*type));
      each.push_back(words(*type) + " (" + name_of_type(*type) + ")");
    }
    return different.size() == 1 ? *different.begin() : listed(each);
  }

  // The types of the design whose model is this one, or any.
  [[nodiscard]] std::vector<const LearnerType*> types_of(const LearnerModel* model) const {
    std::vector<const LearnerType*> types;
    for (const auto& type : spec_.learner_types) {
      if (type.mixture.empty() && is_used(type) && (model == nullptr || type.model == model)) types.push_back(&type);
    }
    return types;
  }

  void learners() {
    if (const auto types = types_of(&bayesian_model()); !types.empty()) bayesian_learners(types);
    for (const auto* type : types_of(nullptr)) {
      if (type->model != &bayesian_model()) other_learners(*type);
    }
    for (const auto& type : spec_.learner_types) {
      std::vector<std::string> parts;
      for (const auto& [letter, share] : type.mixture) {
        parts.push_back("'" + name_of_type(learner_type(spec_, letter)) + "' with probability " + shortest(share));
      }
      if (!parts.empty() && is_used(type)) {
        say("Learners of the type '" + name_of_type(type) + "' were of the type " + listed(parts) + ".");
      }
    }
    for (const auto& type : spec_.learner_types) {
      if (type.prior) say("Learners of the type '" + type.label + "' started from their own prior.");
      if (!type.knowing || !is_used(type)) continue;
      say("Learners of the type '" + name_of_type(type) + "' knew the robot before an update, " + type.knowing->name +
          ": their beliefs began in its behaviour equivalence class, with a share of " + shortest(kBeyondKnown) +
          " beyond it.");
    }
  }

  // In the words of the declarations.
  void other_learners(const LearnerType& type) {
    std::vector<std::string> values;
    for (std::size_t i = 0; i < type.parameters.values().size(); ++i) {
      values.push_back(std::string{type.parameters.declared()[i].name} + " = " +
                       to_string(type.parameters.values()[i]));
    }
    say("Learners of the type '" + name_of_type(type) + "' followed the model '" + std::string{type.model->kind} +
        "' (" + std::string{type.model->description} + ")" + (values.empty() ? "" : " with " + listed(values)) + ".");
  }

  void bayesian_learners(const std::vector<const LearnerType*>& types) {
    const auto real = [&](std::string_view name) {
      return per_type(types, [&](const LearnerType& type) { return shortest(type.parameters.real(name)); });
    };
    const auto spread = [&](std::string_view name) {
      return per_type(types, [&](const LearnerType& type) { return gain(type.parameters.spread(name)); });
    };
    say("The learners' initial abilities were drawn from normal distributions with mean " + real("ability.mean") +
        " and standard deviation " + real("ability.sd") + ", redrawn until between " + real("ability.min") + " and " +
        real("ability_max") + ".");
    say("Ability gains after confirmation were " + spread("confirm_gain") + ", gains after correction " +
        spread("correct_gain") + ", both redrawn until " +
        per_type(types,
                 [](const LearnerType& type) {
                   return "below " + shortest(type.parameters.real("gain_max")) +
                          (type.parameters.boolean("ordered_gains") ? " and the first smaller than the second" : "");
                 }) +
        ".");
    say("Ability rose by the first gain after a period in which all answers were right and by the second after any "
        "other period, up to " +
        real("ability_max") + ", and returned to its initial value at the start of every knowledge component.");
    const auto scale = real("ability_scale");
    if (scale != "1") say("The log-odds of ability were multiplied by " + scale + " at every learning step.");
  }

  static std::string gain(const Spread& distribution) {
    if (distribution.half_normal) return "half-normal with scale " + shortest(*distribution.half_normal);
    return "equal to " + shortest(distribution.value.value_or(0.0));
  }

  void beliefs() {
    const auto& options = spec_.teaching;
    const auto teachers =
        counted(options.filter.particles, "particle") + " and " + shortest(options.filter.process_noise);

    std::vector<const LearnerType*> believers;
    for (const auto* type : types_of(nullptr)) {
      if (num_particles(type->parameters) > 0) believers.push_back(type);
    }
    const auto peoples = per_type(believers, [](const LearnerType& type) {
      const auto particles = counted(num_particles(type.parameters), "particle");
      return particles + " and " + shortest(type.parameters.real("process_noise"));
    });

    const auto own =
        believers.empty() || teachers == peoples ? "" : "; those of the learners themselves had " + peoples;

    say("Beliefs about the reward weights were represented by particle filters on the unit sphere with " +
        counted(options.filter.particles, "particle") + ", the " +
        (options.likelihood == LikelihoodForm::kDiscontinuous ? "discontinuous" : "continuous") +
        " half-space likelihood, systematic resampling" + cite_("kitagawa1996") +
        " when the effective sample size fell below " + shortest(options.filter.resample_below) +
        " of that number, and a process noise (bandwidth factor) of " + shortest(options.filter.process_noise) + own +
        ".");
    say("The teacher assumed an ability of " + shortest(options.assumed_ability) +
        " for every learner and added noise of " + shortest(options.response_noise) +
        " rad to its beliefs after test answers; its common belief followed the largest set of members whose answers "
        "were consistent" +
        (options.reduce_before_update ? ", reduced to the minimal set of their half-spaces." : "."));
  }

  void teaching() {
    const auto& options = spec_.teaching;
    say("Demonstrations were chosen by the information that they convey" + cite_("brown2019machine") + " to " +
        counted(options.counterfactuals, "counterfactual learner") + " drawn " +
        (options.sampling == CounterfactualSampling::kSystematic ? "systematically" : "far from each other") +
        " from the belief of the strategy" +
        (spec_.learner_counterfactuals_self ? "; learners interpreted them with counterfactuals from their own beliefs."
                                            : "."));

    say("A knowledge component was taught " + options.mastery.kind.until(options, options.mastery.parameters) +
        (options.duplicate_sets == 1 ? ""
                                     : ", with " + std::to_string(options.duplicate_sets) + " sets of tests each") +
        "; teaching ended after at most " + counted(options.max_periods, "period") + ".");
    if (options.release) {
      say("Members who " + options.release->kind.released(options, options.release->parameters) +
          " had no part in the remaining periods of a component.");
    }

    const auto ended = [&](SessionStatus status) {
      return std::ranges::count(data_.teams, status, &TeamRecord::status);
    };
    const auto missed = static_cast<std::size_t>(ended(SessionStatus::kMaxPeriods));
    const auto skipped = static_cast<std::size_t>(ended(SessionStatus::kSkipped));

    if (skipped > 0) {
      say(counted(skipped, "team") +
          " did not learn all of some component, because nothing that could be shown conveys the rest, and " +
          (skipped == 1 ? "was" : "were") + " treated as censored.");
    }
    if (missed == 0 && skipped > 0) return;
    say(missed == 0 ? "All teams learned every component."
                    : counted(missed, "team") + " reached this limit and " + (missed == 1 ? "was" : "were") +
                          " treated as censored.");
  }

  void measures() {
    const auto is_baseline = [](const auto& series) { return series.strategy == kBaseline; };
    const bool baseline = std::any_of(design_.series.begin(), design_.series.end(), is_baseline);

    say("Periods are the interaction periods of a team" +
        std::string{baseline ? ", for the baseline summed over its members" : ""} +
        "; knowledge is the probability mass that a person's final belief gives to the behaviour equivalence class of "
        "the policy, averaged over the team.");

    // What only some studies measure.
    if (spec_.exam != ExamLevel::kNone) {
      say("In addition, everybody was examined on all start states: the share right is the expected share of starts "
          "where a person's prediction is as good as the robot's path, and regret is what predictions lose, in the "
          "units "
          "of the reward weights above.");
    }
    if (data_.has_costs) {
      say("Minutes assume " + shortest(spec_.teaching.pace.demonstration_s) + " s per demonstration, " +
          shortest(spec_.teaching.pace.test_s) + " s per test and " + shortest(spec_.teaching.pace.feedback_s) +
          " s for its feedback.");
    }
    if (spec_.estimates) {
      say("Estimates of abilities and of mastery are posterior means over hypotheses about "
          "each person, and are compared with what the simulated people really believed.");
    }
    if (spec_.forecast_sessions > 0) {
      say("Forecasts are distributions over " + counted(spec_.forecast_sessions, "imagined session") +
          " of the same strategy and composition, taught to other people.");
    }
  }

  void statistics() {
    say("Means have 95 % confidence intervals from Student's t distribution over teams (over people where people are "
        "shown), proportions of correct answers have Wilson score intervals" +
        cite_("wilson1927") + ", and completion is one minus the Kaplan-Meier estimate" + cite_("kaplan1958") +
        " with Greenwood's variance on the log scale.");
    if (analysis_.findings.empty()) return;
    say("Tests used the significance level " + shortest(AnalysisOptions{}.alpha) + ".");
    for (const auto& topic : topics()) say(tested(topic));
  }

  // Findings that differ in the response only.
  struct Topic {
    std::string title;
    std::vector<std::pair<std::string, const Finding*>> findings;  // by response; may be empty
  };
  [[nodiscard]] std::vector<Topic> topics() const {
    std::vector<Topic> topics;
    for (const auto& finding : analysis_.findings) {
      if (finding.methods.empty()) continue;
      auto title = finding.topic;
      title[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(title[0])));
      if (topics.empty() || topics.back().title != title) topics.push_back({title, {}});
      topics.back().findings.emplace_back(finding.response, &finding);
    }
    return topics;
  }

  // "Effects of strategy and composition (periods and knowledge): ..., ... and ...; for periods also ...".
  std::string tested(const Topic& topic) {
    const auto has = [](const Finding& finding, const Method& method) {
      return std::any_of(finding.methods.begin(), finding.methods.end(),
                         [&](const auto& one) { return one.text == method.text; });
    };
    const auto in_all = [&](const Method& method) {
      return std::all_of(topic.findings.begin(), topic.findings.end(),
                         [&](const auto& one) { return has(*one.second, method); });
    };

    // What all responses of the topic have in common is said once.
    std::vector<std::string> responses, common;
    for (const auto& [response, finding] : topic.findings) {
      if (!response.empty()) responses.push_back(response);
    }
    for (const auto& method : topic.findings.front().second->methods) {
      if (in_all(method)) common.push_back(method.text + cite_(method.source));
    }

    auto text = topic.title + (responses.empty() ? "" : " (" + listed(responses) + ")") + ": " + listed(common);
    for (const auto& [response, finding] : topic.findings) {
      std::vector<std::string> own;
      for (const auto& method : finding->methods) {
        if (!in_all(method)) own.push_back(method.text + cite_(method.source));
      }
      if (!own.empty()) text += "; for " + response + (common.empty() ? " " : " also ") + listed(own);
    }
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
    return text + ".";
  }

  const RunFiles& run_;
  const StudySpec& spec_;
  const ReportDesign& design_;
  const RunData& data_;
  const Analysis& analysis_;
  Citations cite_;
  std::string text_;
};

}  // namespace

Json methods_of(const RunFiles& run, const ReportDesign& design, const RunData& data, const Analysis& analysis) {
  return Paragraph{run, design, data, analysis}.write();
}

}  // namespace kith::detail
