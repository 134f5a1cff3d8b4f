// PRISM's explicit files: .tra, .sta, .lab, .srew and .trew (PRISM manual, appendix "Explicit model files").
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "kith/models/model_formats.hpp"

namespace kith::detail {
namespace {

// The lines of a file that say something, each split at blanks. Lines that begin with '#' are comments.
class Lines {
 public:
  explicit Lines(const ModelText& file) : file_{file} {}

  // Goes on to the next line; false at the end.
  bool next() {
    const std::string_view text = file_.text;
    while (at_ < text.size()) {
      const std::size_t end = std::min(text.find('\n', at_), text.size());
      line_ = text.substr(at_, end - at_);
      at_ = end + 1;
      while (!line_.empty() && (line_.back() == '\r' || line_.back() == ' ' || line_.back() == '\t')) {
        line_.remove_suffix(1);
      }
      if (line_.empty() || line_.front() == '#') continue;
      split();
      if (!words_.empty()) return true;
    }
    return false;
  }

  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] const std::vector<std::string_view>& words() const { return words_; }
  [[nodiscard]] ModelPlace place() const { return place_of(file_, line_); }
  [[nodiscard]] ModelPlace place(std::size_t word) const {
    return word < words_.size() ? place_of(file_, words_[word]) : place();
  }
  [[nodiscard]] ModelPlace end() const { return {&file_, file_.text.size(), 1}; }

 private:
  void split() {
    words_.clear();
    std::size_t begin = line_.find_first_not_of(" \t");
    while (begin != std::string_view::npos) {
      const std::size_t end = std::min(line_.find_first_of(" \t", begin), line_.size());
      words_.push_back(line_.substr(begin, end - begin));
      begin = line_.find_first_not_of(" \t", end);
    }
  }

  const ModelText& file_;
  std::size_t at_ = 0;
  std::string_view line_;
  std::vector<std::string_view> words_;
};

std::optional<std::uint32_t> index_from(std::string_view word) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool sound = error == std::errc{} && end == word.data() + word.size();
  return sound && value < std::numeric_limits<std::uint32_t>::max() ? std::optional{value} : std::nullopt;
}

std::optional<double> plain_number(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc{} && end == word.data() + word.size() ? std::optional{value} : std::nullopt;
}

// A number, also as a fraction, which PRISM writes where it computes exactly.
std::optional<double> number_from(std::string_view word) {
  const std::size_t slash = word.find('/');
  if (slash == std::string_view::npos) return plain_number(word);
  const auto above = plain_number(word.substr(0, slash));
  const auto below = plain_number(word.substr(slash + 1));
  return above && below && *below != 0.0 ? std::optional{*above / *below} : std::nullopt;
}

class PrismReader {
 public:
  PrismReader(const PrismFiles& files, RawModel& model, ModelReport& report)
      : files_{files}, model_{model}, report_{report} {}

  void read() {
    mdp_.name = files_.mdp;
    mdp_.file = files_.transitions;
    mdp_.place = {files_.transitions};
    if (!read_transitions()) return;
    if (files_.states != nullptr) read_states(*files_.states);
    if (files_.states == nullptr && !model_.variables.empty()) {
      report_.error("E0239", mdp_.place, "this MDP has no states file, but others have",
                    "all MDPs of a domain share their variables");
    }
    for (std::size_t k = 0; k < files_.rewards.size(); ++k) {
      for (const ModelText* file : files_.rewards[k]) read_rewards(*file, k);
    }
    if (report_.has_errors()) return;
    add_rows();
    if (files_.labels != nullptr) read_labels(*files_.labels);
    if (files_.terminal.empty()) find_terminals();
    model_.mdps.push_back(std::move(mdp_));
  }

 private:
  bool malformed(const ModelPlace& place, const std::string& expected) {
    report_.error("E0236", place, "expected " + expected, "see PRISM's manual, explicit model files");
    return false;
  }

  std::optional<std::uint32_t> state(const Lines& lines, std::size_t word) {
    const auto number = word < lines.words().size() ? index_from(lines.words()[word]) : std::nullopt;
    if (!number) {
      (void)malformed(lines.place(word), "the number of a state");
    } else if (*number >= num_states_) {
      report_.error("E0240", lines.place(word), "there is no state " + std::to_string(*number),
                    "states are numbered 0 to " + std::to_string(num_states_ - 1) + " (first line of the .tra file)");
      return std::nullopt;
    }
    return number;
  }

  // "n c m", then "i k j x [action]".
  bool read_transitions() {
    Lines lines{*files_.transitions};
    if (!lines.next()) return malformed(lines.end(), "a line with the numbers of states, choices and transitions");
    const auto header = numbers(lines, 3, "the numbers of states, choices and transitions of an MDP, as in '6 10 16'");
    if (!header) return false;
    if ((*header)[0] == 0 || (*header)[0] > kMaxModelStates) {
      report_.error("E0257", lines.place(0), "a model has 1 to " + std::to_string(kMaxModelStates) + " states",
                    "leave out what the robot cannot reach");
      return false;
    }
    const ModelPlace header_place = lines.place();
    if ((*header)[0] > files_.transitions->text.size()) {  // and most states have a line
      report_.error("E0237", header_place, "the first line declares more states than the file can have",
                    "the file may be cut off: export it again");
      return false;
    }
    num_states_ = (*header)[0];
    mdp_.states.resize(num_states_);
    for (std::uint32_t s = 0; s < num_states_; ++s) {
      mdp_.states[s].key = std::to_string(s);
      mdp_.states[s].place = {files_.transitions};
    }
    while (!stopped_ && lines.next() && !report_.is_full()) {
      if (!has_room(model_, lines.place(), report_) || mdp_.transitions.size() == kMaxTransitions) return false;
      add_transition(lines);
    }
    if (!report_.has_errors() && num_lines_ != (*header)[2]) {
      report_.error("E0237", header_place,
                    "the first line declares " + std::to_string((*header)[2]) + " transitions, but there are " +
                        std::to_string(num_lines_),
                    "the file may be cut off: export it again");
    }
    return !report_.has_errors();
  }

  std::optional<std::vector<std::uint32_t>> numbers(const Lines& lines, std::size_t count,
                                                    const std::string& expected) {
    std::vector<std::uint32_t> result;
    for (const std::string_view word : lines.words()) {
      const auto number = index_from(word);
      if (number) result.push_back(*number);
    }
    if (result.size() == count && lines.words().size() == count) return result;
    (void)malformed(lines.place(), expected);
    return std::nullopt;
  }

  void add_transition(const Lines& lines) {
    const auto& words = lines.words();
    if (!check_dialect(lines)) return;
    if (words.size() != 4 && words.size() != 5) {
      (void)malformed(lines.place(), "state, choice, next state, probability and perhaps an action");
      return;
    }
    const auto from = state(lines, 0);
    const auto choice = index_from(words[1]);
    const auto next = state(lines, 2);
    const auto probability = number_from(words[3]);
    if (!choice) (void)malformed(lines.place(1), "the number of a choice");
    if (!probability) (void)malformed(lines.place(3), "a probability");
    const bool is_plain =
        std::all_of(words.back().begin(), words.back().end(), [](char c) { return c > ' ' && c < 0x7F; });
    if (!is_plain) (void)malformed(lines.place(words.size() - 1), "an action in ASCII letters");
    if (!from || !choice || !next || !probability || !is_plain) return;
    ++num_lines_;
    // Without an action, that is how PRISM writes states in which nothing can be done.
    if (words.size() == 4 && *from == *next && *probability == 1.0) return;
    const std::string name = words.size() == 5 ? std::string{words[4]} : "choice " + std::to_string(*choice);
    const auto action = action_number(model_, name, lines.place(words.size() == 5 ? 4 : 1), report_);
    if (!action || !check_choice(lines, *from, *choice, *action)) return;
    RawTransition transition;
    transition.state = *from;
    transition.action = *action;
    transition.next = *next;
    transition.probability = *probability;
    transition.at = static_cast<std::uint32_t>(lines.place(0).offset);
    transition.probability_at = static_cast<std::uint32_t>(lines.place(3).offset);
    mdp_.transitions.push_back(transition);
  }

  // Other exports than those of MDPs, transition by transition, are refused once.
  bool check_dialect(const Lines& lines) {
    const auto& words = lines.words();
    const bool is_row = words.size() > 2 && words[2].find(':') != std::string_view::npos;
    const bool is_interval = words.size() > 3 && words[3].front() == '[';
    if (is_row) report_.error("E0236", lines.place(2), "this was exported with rows", "export without -exportrows");
    if (is_interval) {
      report_.error("E0236", lines.place(3), "the probabilities are intervals (an interval MDP); kith needs numbers",
                    "choose a probability in each interval");
    }
    stopped_ = is_row || is_interval;
    return !stopped_;
  }

  // PRISM allows several choices of one action in a state; people would not know which is meant.
  bool check_choice(const Lines& lines, std::uint32_t from, std::uint32_t choice, std::uint32_t action) {
    const auto [of_choice, is_new] = action_of_.try_emplace({from, choice}, action);
    const auto [of_action, first] = choice_of_.try_emplace({from, action}, choice);
    if (of_choice->second == action && of_action->second == choice) return true;
    report_.error("E0238", lines.place(4),
                  "choices and actions of state " + std::to_string(from) +
                      " do not match: each choice must be a different action",
                  "give every choice of a state an action of its own");
    return false;
  }

  // "(a,b)", then "i:(1,2)".
  void read_states(const ModelText& file) {
    Lines lines{file};
    if (!lines.next()) return void(malformed(lines.end(), "the names of variables, as in '(x,y)'"));
    const auto names = tuple(lines.line());
    if (!names || names->empty()) return void(malformed(lines.place(), "the names of variables, as in '(x,y)'"));

    std::vector<std::string> variables{names->begin(), names->end()};
    for (const std::string& one : variables) {
      if (!std::all_of(one.begin(), one.end(), [](char c) { return c >= ' ' && c < 0x7F; })) {
        return void(malformed(lines.place(), "names of variables in ASCII letters"));
      }
    }
    if (model_.mdps.empty()) {
      model_.variables = variables;
    } else if (model_.variables != variables) {
      report_.error("E0239", lines.place(), "the variables are not those of the first MDP",
                    "all MDPs of a domain share their variables");
      return;
    }
    if (variables.size() > kMaxVariables) {
      report_.error("E0257", lines.place(), "states have more than " + std::to_string(kMaxVariables) + " variables",
                    "leave some out");
      return;
    }

    mdp_.variables.assign(std::size_t{num_states_} * variables.size(), 0);
    std::vector<bool> seen(num_states_, false);
    while (lines.next() && !report_.is_full()) add_state(file, lines, variables.size(), seen);

    const auto missing = std::find(seen.begin(), seen.end(), false);
    if (!report_.has_errors() && missing != seen.end()) {
      report_.error("E0237", lines.end(), "state " + std::to_string(missing - seen.begin()) + " is missing",
                    "the file must have a line for every state of " + files_.transitions->name);
    }
  }

  // The parts of "(a,b)" anywhere in a line.
  static std::optional<std::vector<std::string_view>> tuple(std::string_view line) {
    const std::size_t open = line.find('(');
    if (open == std::string_view::npos || line.back() != ')') return std::nullopt;
    std::vector<std::string_view> parts;
    std::string_view rest = line.substr(open + 1, line.size() - open - 2);
    while (true) {
      const std::size_t comma = rest.find(',');
      parts.push_back(rest.substr(0, comma));
      if (comma == std::string_view::npos) return parts;
      rest.remove_prefix(comma + 1);
    }
  }

  void add_state(const ModelText& file, const Lines& lines, std::size_t num_variables, std::vector<bool>& seen) {
    const std::string_view line = lines.line();
    const std::size_t colon = line.find(':');
    const auto number = index_from(line.substr(0, colon == std::string_view::npos ? 0 : colon));
    const auto values = tuple(line);
    if (!number || !values || values->size() != num_variables) {
      return void(
          malformed(lines.place(), "a state and its " + std::to_string(num_variables) + " values, as in '3:(1,0)'"));
    }
    if (*number >= num_states_ || seen[*number]) {
      report_.error(*number >= num_states_ ? "E0240" : "E0241", lines.place(),
                    *number >= num_states_ ? "there is no state " + std::to_string(*number)
                                           : "state " + std::to_string(*number) + " is given twice",
                    "states are numbered 0 to " + std::to_string(num_states_ - 1));
      return;
    }

    seen[*number] = true;
    mdp_.states[*number].place = lines.place();
    for (std::size_t v = 0; v < num_variables; ++v) {
      const std::string_view word = (*values)[v];
      std::int32_t value = word == "true" ? 1 : 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      const bool is_number = error == std::errc{} && end == word.data() + word.size();
      if (!is_number && word != "true" && word != "false") {
        return void(malformed(place_of(file, word), "an integer, true or false"));
      }
      mdp_.variables[*number * num_variables + v] = value;
    }
  }

  // .srew: "n m", then "i x"; .trew: "n c m", then "i k j x".
  void read_rewards(const ModelText& file, std::size_t feature) {
    Lines lines{file};
    if (!lines.next()) return void(malformed(lines.end(), "a line with the numbers of states and rewards"));
    const bool of_states = lines.words().size() == 2;
    if (!numbers(lines, of_states ? 2 : 3, "'states rewards' (.srew) or 'states choices rewards' (.trew)")) return;
    if (index_from(lines.words()[0]) != num_states_) {
      report_.error("E0237", lines.place(0),
                    "these are not the rewards of this model: it has " + std::to_string(num_states_) + " states",
                    "export all files at once");
      return;
    }
    std::set<std::array<std::uint32_t, 3>> seen;  // state, choice, next state
    while (lines.next() && !report_.is_full()) {
      const std::size_t width = of_states ? 2 : 4;
      if (lines.words().size() != width) {
        return void(
            malformed(lines.place(), of_states ? "a state and its reward" : "state, choice, next state and reward"));
      }
      const auto from = state(lines, 0);
      const auto reward = number_from(lines.words()[width - 1]);
      if (!reward) (void)malformed(lines.place(width - 1), "a number");
      if (!from || !reward || !check_finite(*reward, "a reward", lines.place(width - 1), report_)) continue;
      std::array<std::uint32_t, 3> where{*from, 0, 0};
      for (std::size_t w = 1; w + 1 < width; ++w) where.at(w) = index_from(lines.words()[w]).value_or(0);
      if (!seen.insert(where).second) {
        report_.error("E0252", lines.place(),
                      "the reward of this " + std::string{of_states ? "state" : "transition"} + " is given twice",
                      "keep one of the lines");
        continue;
      }
      if (of_states) {
        state_rewards_[{*from, feature}] += *reward;
      } else {
        add_transition_reward(lines, *from, feature, *reward);
      }
    }
  }

  void add_transition_reward(const Lines& lines, std::uint32_t from, std::size_t feature, double reward) {
    const auto choice = index_from(lines.words()[1]);
    const auto next = state(lines, 2);
    if (!choice) (void)malformed(lines.place(1), "the number of a choice");
    if (!choice || !next) return;
    if (positions_.empty()) index_transitions();
    const auto action = action_of_.find({from, *choice});
    const auto at = action == action_of_.end() ? positions_.end() : positions_.find({from, action->second, *next});
    if (at == positions_.end() && *next == from && *choice == 0 && action == action_of_.end()) {
      if (reward != 0.0) state_rewards_[{from, feature}] += reward;  // of a state in which nothing can be done
      return;
    }
    if (at == positions_.end()) {
      report_.error("E0252", lines.place(), "there is no such transition in " + files_.transitions->name,
                    "export all files at once");
      return;
    }
    transition_rewards_[{at->second, feature}] += reward;
  }

  void index_transitions() {
    for (std::uint32_t i = 0; i < mdp_.transitions.size(); ++i) {
      const RawTransition& one = mdp_.transitions[i];
      positions_.try_emplace({one.state, one.action, one.next}, i);
    }
  }

  void add_rows() {
    const std::size_t d = files_.rewards.size();
    std::vector<std::vector<double>> rows(mdp_.transitions.size(), std::vector<double>(d, 0.0));
    for (const auto& [where, reward] : transition_rewards_) rows[where.first][where.second] += reward;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t k = 0; k < d && !state_rewards_.empty(); ++k) {
        const auto at = state_rewards_.find({mdp_.transitions[i].state, k});
        if (at != state_rewards_.end()) rows[i][k] += at->second;
      }
      mdp_.transitions[i].features = model_.features.number_of(rows[i]);
    }
    note_rewards_at_ends();
    model_.num_transitions += mdp_.transitions.size();
  }

  // Those of states from which nothing leads on are on no transition.
  void note_rewards_at_ends() {
    std::set<std::uint32_t> left;
    for (const RawTransition& one : mdp_.transitions) left.insert(one.state);
    for (const auto& [where, reward] : state_rewards_) {
      if (reward == 0.0 || left.contains(where.first)) continue;
      return report_.warning(
          "W0210", mdp_.states[where.first].place,
          "the reward of state " + std::to_string(where.first) + ", in which nothing can be done, is left out",
          "it is said for the first such state");
    }
  }

  // '0="init" 1="deadlock" 2="goal"', then "i: 0 2".
  void read_labels(const ModelText& file) {
    Lines lines{file};
    if (!lines.next()) return void(malformed(lines.end(), "the names of labels, as in '0=\"init\" 1=\"goal\"'"));
    std::map<std::uint32_t, std::string> names;
    for (std::size_t w = 0; w < lines.words().size(); ++w) {
      const std::string_view word = lines.words()[w];
      const std::size_t equals = word.find("=\"");
      const auto number = index_from(word.substr(0, equals == std::string_view::npos ? 0 : equals));
      if (!number || word.size() < equals + 3 || word.back() != '"') {
        return void(malformed(lines.place(w), "the names of labels, as in '0=\"init\" 1=\"goal\"'"));
      }
      if (!names.try_emplace(*number, word.substr(equals + 2, word.size() - equals - 3)).second) {
        report_.error("E0251", lines.place(w), "label " + std::to_string(*number) + " is named twice",
                      "give every label a number of its own");
      }
    }
    check_label(files_.terminal, names, lines.place());
    check_label(files_.start, names, lines.place());
    std::vector<bool> seen(num_states_, false);
    while (lines.next() && !report_.is_full()) add_labels(lines, names, seen);
  }

  void check_label(const std::string& wanted, const std::map<std::uint32_t, std::string>& names,
                   const ModelPlace& place) {
    std::vector<std::string> known;
    known.reserve(names.size());
    for (const auto& [number, name] : names) known.push_back(name);
    if (wanted.empty() || std::find(known.begin(), known.end(), wanted) != known.end()) return;
    report_.error("E0251", place, "there is no label '" + wanted + "', which the domain file asks for",
                  name_hint(wanted, known));
  }

  void add_labels(const Lines& lines, const std::map<std::uint32_t, std::string>& names, std::vector<bool>& seen) {
    const auto& words = lines.words();
    const bool has_colon = words[0].back() == ':';
    const auto number = index_from(words[0].substr(0, words[0].size() - (has_colon ? 1 : 0)));
    if (!has_colon || !number) return void(malformed(lines.place(0), "a state and its labels, as in '3: 1 2'"));
    if (*number >= num_states_) {
      report_.error("E0240", lines.place(0), "there is no state " + std::to_string(*number),
                    "states are numbered 0 to " + std::to_string(num_states_ - 1));
      return;
    }
    if (seen[*number]) {
      report_.error("E0241", lines.place(0), "state " + std::to_string(*number) + " is given twice",
                    "write all labels of a state on one line");
      return;
    }

    seen[*number] = true;
    RawState& state = mdp_.states[*number];
    for (std::size_t w = 1; w < words.size(); ++w) {
      const auto label = index_from(words[w]);
      const auto at = label ? names.find(*label) : names.end();
      if (at == names.end()) return void(malformed(lines.place(w), "the number of a label"));
      if (!files_.terminal.empty() && at->second == files_.terminal) state.terminal = true;
      if (!files_.start.empty() && at->second == files_.start) state.start = true;
      if (at->second == "init") state.initial = true;  // perhaps several
      if (files_.states == nullptr) state.place = lines.place(0);
    }
  }

  // Without a label the states are terminal that are never left.
  void find_terminals() {
    std::vector<bool> left(num_states_, false);
    for (const RawTransition& one : mdp_.transitions) {
      if (one.next != one.state && one.probability > 0.0) left[one.state] = true;
    }
    for (std::uint32_t s = 0; s < num_states_; ++s) mdp_.states[s].terminal = !left[s];
  }

  const PrismFiles& files_;
  RawModel& model_;
  ModelReport& report_;
  RawMdp mdp_;
  std::uint32_t num_states_ = 0;
  bool stopped_ = false;
  std::size_t num_lines_ = 0;                                                   // of transitions
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> action_of_;  // by state and choice
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> choice_of_;  // by state and action
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::uint32_t> positions_;
  std::map<std::pair<std::uint32_t, std::size_t>, double> state_rewards_;       // by state and feature
  std::map<std::pair<std::uint32_t, std::size_t>, double> transition_rewards_;  // by transition and feature
};

}  // namespace

void read_prism_mdp(const PrismFiles& files, RawModel& model, ModelReport& report) {
  model.terminals_may_have_rows = true;
  model.initial_may_repeat = true;
  PrismReader{files, model, report}.read();
}

}  // namespace kith::detail
