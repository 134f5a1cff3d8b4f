// Storm's DRN, PRISM's explicit files, Cassandra's MDP format and Gymnasium's transition tables.
#include <nlohmann/json.hpp>

#include "export_view.hpp"
#include "kith/toml/document.hpp"

namespace kith::detail {
namespace {

// "[0, 2.5, 1]"
std::string rewards_text(const std::vector<double>& features, double reward) {
  std::string text = "[";
  for (const double x : features) text += number_text(x) + ", ";
  return text + number_text(reward) + "]";
}

std::string index_text(std::size_t number) { return std::to_string(number); }

}  // namespace

// Storm: src/storm-parsers/parser/DirectEncodingParser.cpp says what is read.
std::string drn_text(const ExportView& view) {
  const std::size_t d = view.domain().num_features();
  const auto actions = plain_names(view.domain().action_names());
  std::size_t num_choices = view.mdp().num_terminals();
  for (std::size_t s = 0; s < view.mdp().num_states(); ++s) num_choices += view.mdp().choices(StateIndex{s}).size();
  std::string text = "// " + view.title() + "\n// discount " + number_text(view.mdp().discount()) +
                     "\n@type: MDP\n@parameters\n\n@reward_models\n";
  for (const std::string& feature : plain_names(view.domain().feature_names())) text += "feature_" + feature + " ";
  text += "reward\n@nr_states\n" + index_text(view.num_states()) + "\n@nr_choices\n" + index_text(num_choices) +
          "\n@model\n";
  const std::vector<double> nothing(d, 0.0);
  for (std::size_t s = 0; s < view.num_states(); ++s) {
    text += "state " + index_text(s) + " " + rewards_text(nothing, 0.0);
    if (s == view.initial()) text += " init";
    if (view.is_start(s)) text += " start";
    if (view.is_terminal(s)) text += " goal";
    text += "\n// " + view.state_name(s) + "\n";
    if (view.is_terminal(s)) {
      text += "\taction end " + rewards_text(nothing, 0.0) + "\n\t\t" + index_text(s) + " : 1\n";
    }
    for (const ExportedChoice& choice : view.choices(s)) {
      std::vector<double> expected(d, 0.0);
      double reward = 0.0;
      for (const ExportedOutcome& one : choice.outcomes) {
        for (std::size_t k = 0; k < d; ++k) expected[k] += one.probability * one.features[k];
        reward += one.probability * one.reward;
      }
      text += "\taction " + actions[choice.action] + " " + rewards_text(expected, reward) + "\n";
      for (const ExportedOutcome& one : choice.outcomes) {
        text += "\t\t" + index_text(one.next) + " : " + number_text(one.probability) + "\n";
      }
    }
  }
  return text;
}

// pomdp.org's file format, of which an MDP is what has no observations: then rewards have no observation either.
std::string cassandra_text(const ExportView& view) {
  const auto actions = plain_names(view.domain().action_names());
  std::string text = "# " + view.title() +
                     "\n# states are numbered; terminal ones, which are left by nothing, come last\n" +
                     "discount: " + decimal_text(view.mdp().discount()) +
                     "\nvalues: reward\nstates: " + index_text(view.num_states()) + "\nactions:";
  // Names begin with a letter there.
  for (const std::string& action : actions) text += " a_" + action;
  text += "\nstart: " + index_text(view.initial()) + "\n";
  const std::string loss = decimal_text(view.loss());
  for (std::size_t s = 0; s < view.num_states(); ++s) {
    text += "\n# " + view.state_name(s) + "\n";
    const auto choices = view.choices(s);
    auto choice = choices.begin();
    for (std::size_t a = 0; a < actions.size(); ++a) {
      const std::string where = index_text(a) + " : " + index_text(s) + " : ";
      if (choice == choices.end() || choice->action != a) {
        text += "T: " + where + index_text(s) + " 1.0\n";
        if (!view.is_terminal(s))
          text.append("R: ").append(where).append(index_text(s)).append(" ").append(loss).append("\n");
        continue;
      }
      for (const ExportedOutcome& one : choice->outcomes) {
        text += "T: " + where + index_text(one.next) + " " + decimal_text(one.probability) + "\n";
        if (one.reward != 0.0) text += "R: " + where + index_text(one.next) + " " + decimal_text(one.reward) + "\n";
      }
      ++choice;
    }
  }
  return text;
}

std::string gym_text(const ExportView& view) {
  using Json = nlohmann::ordered_json;
  Json table = Json::object();
  Json phi = Json::object();
  const auto& actions = view.domain().action_names();
  const std::vector<double> nothing(view.domain().num_features(), 0.0);
  for (std::size_t s = 0; s < view.num_states(); ++s) {
    const auto choices = view.choices(s);
    auto choice = choices.begin();
    Json& rows = table[index_text(s)];
    Json& vectors = phi[index_text(s)];
    for (std::size_t a = 0; a < actions.size(); ++a) {
      Json outcomes = Json::array();
      Json features = Json::array();
      if (choice != choices.end() && choice->action == a) {
        for (const ExportedOutcome& one : choice->outcomes) {
          outcomes.push_back({one.probability, one.next, one.reward, view.is_terminal(one.next)});
          features.push_back(one.features);
        }
        ++choice;
      } else {
        const bool terminal = view.is_terminal(s);
        outcomes.push_back({1.0, s, terminal ? 0.0 : view.loss(), terminal});
        features.push_back(nothing);
      }
      rows[index_text(a)] = std::move(outcomes);
      vectors[index_text(a)] = std::move(features);
    }
  }
  std::vector<std::string> names;
  std::vector<std::size_t> starts;
  for (std::size_t s = 0; s < view.num_states(); ++s) names.push_back(view.state_name(s));
  for (const StateIndex s : view.domain().starts(view.number())) starts.push_back(s.value());
  const Json document{{"title", view.title()},
                      {"discount", view.mdp().discount()},
                      {"initial", view.initial()},
                      {"starts", starts},
                      {"actions", actions},
                      {"features", view.domain().feature_names()},
                      {"weights", view.domain().weights().raw},
                      {"states", names},
                      {"P", table},
                      {"phi", phi}};
  return document.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

// PRISM manual, appendix "Explicit model files".
std::vector<ExportedFile> prism_files(const ExportView& view, const std::string& name) {
  const auto actions = plain_names(view.domain().action_names());
  const auto features = plain_names(view.domain().feature_names());
  std::string transitions;
  std::vector<std::string> rewards(features.size());
  std::vector<std::size_t> num_rewards(features.size(), 0);
  std::size_t num_choices = 0;
  std::size_t num_transitions = 0;
  for (std::size_t s = 0; s < view.num_states(); ++s) {
    if (view.is_terminal(s)) {
      transitions += index_text(s) + " 0 " + index_text(s) + " 1\n";
      ++num_choices;
      ++num_transitions;
    }
    std::size_t c = 0;
    for (const ExportedChoice& choice : view.choices(s)) {
      const std::string which = index_text(s) + " " + index_text(c++) + " ";
      ++num_choices;
      for (const ExportedOutcome& one : choice.outcomes) {
        ++num_transitions;
        transitions +=
            which + index_text(one.next) + " " + number_text(one.probability) + " " + actions[choice.action] + "\n";
        for (std::size_t k = 0; k < features.size(); ++k) {
          if (one.features[k] == 0.0) continue;
          ++num_rewards[k];
          rewards[k] += which + index_text(one.next) + " " + number_text(one.features[k]) + "\n";
        }
      }
    }
  }
  const std::string size = index_text(view.num_states()) + " " + index_text(num_choices) + " ";
  std::string labels = "0=\"init\" 1=\"deadlock\" 2=\"goal\" 3=\"start\"\n";
  std::string states = "(s)\n";
  for (std::size_t s = 0; s < view.num_states(); ++s) {
    std::string which = s == view.initial() ? " 0" : "";
    if (view.is_terminal(s)) which += " 2";
    if (view.is_start(s)) which += " 3";
    if (!which.empty()) labels += index_text(s) + ":" + which + "\n";
    states += index_text(s) + ":(" + index_text(s) + ")\n";
  }
  const auto quoted = [](const std::string& text) { return to_toml(TomlValue{text}); };
  std::vector<ExportedFile> files{{name + ".tra", size + index_text(num_transitions) + "\n" + transitions},
                                  {name + ".sta", states},
                                  {name + ".lab", labels}};
  std::string names;
  for (std::size_t k = 0; k < features.size(); ++k) {
    std::string structure = features[k];
    for (char& c : structure) c = c == '-' ? '_' : c;
    const std::string file = name + "." + features[k] + ".trew";
    names.append(k == 0 ? "" : ", ")
        .append(quoted(view.domain().feature_names()[k]))
        .append(" = ")
        .append(quoted(file));
    auto text = "# Reward structure \"" + structure + "\"\n# Transition rewards\n";
    text.append(size).append(index_text(num_rewards[k])).append("\n").append(rewards[k]);
    files.push_back({file, std::move(text)});
  }
  const std::string model =
      "[model]\nformat = \"prism\"\nterminal = \"goal\"\nstart = \"start\"\n[[model.mdp]]\ntransitions = " +
      quoted(name + ".tra") + "\nlabels = " + quoted(name + ".lab") + "\nrewards = { " + names + " }\n";
  files.push_back({name + ".toml", domain_text(view, actions, model)});
  return files;
}

}  // namespace kith::detail
