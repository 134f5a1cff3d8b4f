// PRISM's explicit files and Gymnasium's transition tables.
#include <nlohmann/json.hpp>

#include "export_view.hpp"
#include "kith/toml/document.hpp"

namespace kith::detail {
namespace {

std::string index_text(std::size_t number) { return std::to_string(number); }

}  // namespace

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
