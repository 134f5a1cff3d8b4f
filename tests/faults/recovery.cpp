#include "recovery.hpp"

#include <algorithm>
#include <cctype>
#include <set>
#include <sstream>

#include "readers.hpp"

namespace kith::faults {
namespace {

namespace fs = std::filesystem;

std::string folder_of(const Words& words) {
  const auto out = std::find(words.begin(), words.end(), "-o");
  return out == words.end() || out + 1 == words.end() ? std::string{} : *(out + 1);
}

bool has(const std::string& text, const std::string& piece) { return text.find(piece) != std::string::npos; }

bool has_word(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool starts_over(const Words& words) { return has_word(words, "never"); }

// What a refusal says to add to the command; empty if nothing, or nothing new.
Words remedy_in(const std::string& message, const Words& words) {
  if (has(message, "--resume never") && !starts_over(words)) return {"--resume", "never"};
  if (has(message, "--yes") && !has_word(words, "--yes")) return {"--yes"};
  return {};
}

std::vector<std::size_t> numbers_in(const std::string& line) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (std::isdigit(static_cast<unsigned char>(line[i])) == 0) continue;
    const bool in_word = i > 0 && std::isalnum(static_cast<unsigned char>(line[i - 1])) != 0;
    std::size_t number = 0;
    while (i < line.size() && std::isdigit(static_cast<unsigned char>(line[i])) != 0) {
      number = number * 10 + static_cast<std::size_t>(line[i++] - '0');
    }
    if (!in_word) numbers.push_back(number);
  }
  return numbers;
}

// Whether messages say that so many records are lost, or so many left: in a line about records or the journal, by
// their number or by naming each of their teams. Where nothing is left, naming the damaged journal will do.
bool names_loss(const std::string& messages, std::size_t lost, std::size_t left) {
  std::istringstream lines{messages};
  std::set<std::size_t> teams;
  for (std::string line; std::getline(lines, line);) {
    if (!has(line, ".sqlite") && !has(line, "record") && !has(line, "recovered")) continue;
    if (left == 0) return true;
    const auto numbers = numbers_in(line);
    if (std::count(numbers.begin(), numbers.end(), lost) > 0) return true;
    if (std::count(numbers.begin(), numbers.end(), left) > 0) return true;
    const auto at = line.find("team ");
    const auto team = at == std::string::npos ? numbers : numbers_in(line.substr(at));
    if (!team.empty()) teams.insert(team.front());
  }
  return teams.size() == lost;
}

}  // namespace

Recovery::Recovery(const Scenario& scenario, const Models& models, fs::path root)
    : scenario_{scenario}, models_{models}, root_{std::move(root)} {}

void Recovery::look() {
  for (const auto& words : scenario_.commands) {
    const auto folder = folder_of(words);
    if (words.front() != "study") continue;
    saved_[folder] = readable_records(root_ / folder, models_.records_of(folder), root_ / ".." / "journals").size();
  }
}

Recovered Recovery::run(bool may_refuse, bool is_mixed, bool verifies) {
  for (const auto& words : scenario_.commands) persist(words, may_refuse, is_mixed);
  if (files_below(root_ / "run" / "tables") != models_.expected().tables) result_.wrong += "the tables are others; ";
  if (result_.wrong.empty() && verifies) {
    const auto verify = run_kith(models_.tools(), root_, {"verify", "run"});
    if (verify.code != 0) result_.wrong += "verify of the finished run: " + verify.err.substr(0, 200) + "; ";
  }
  return result_;
}

void Recovery::persist(Words words, bool may_refuse, bool is_mixed) {
  const auto folder = folder_of(words);
  const bool is_study = words.front() == "study";
  const auto readable =
      is_study ? readable_records(root_ / folder, models_.records_of(folder), root_ / ".." / "journals").size() : 0;
  std::string messages;
  bool refused = false;
  auto ended = run_kith(models_.tools(), root_, words);
  messages += ended.err;
  while (ended.code != 0) {
    const auto command = words.front() + " again";
    result_.wrong += wrong_ending(command, ended);
    const auto remedy = remedy_in(ended.err, words);
    if (!may_refuse || remedy.empty() || ended.code == 1 || ended.code == 6 || ended.code > 7) {
      result_.wrong += command + " exits with " + std::to_string(ended.code) + " (" + ended.err.substr(0, 300) + "); ";
      return;
    }
    result_.refused = refused = true;
    words.insert(words.end(), remedy.begin(), remedy.end());
    ended = run_kith(models_.tools(), root_, words);
    messages += ended.err;
  }
  const bool anew = starts_over(scenario_.commands.front());
  if (is_study && !anew && !(refused && is_mixed)) check_teams(words, folder, readable, messages);
}

void Recovery::check_teams(const Words& words, const std::string& folder, std::size_t readable,
                           const std::string& messages) {
  const auto taken = starts_over(words) ? std::size_t{0} : static_cast<std::size_t>(teams_taken_up(messages));
  if (taken < readable) {
    result_.wrong += "only " + std::to_string(taken) + " of " + std::to_string(readable) +
                     " records that can be read are taken up (" + messages.substr(0, 300) + "); ";
  }
  const auto saved = saved_.at(folder);
  if (taken >= saved) return;
  result_.lost += static_cast<int>(saved - taken);
  if (damaged_.rfind(folder + "/", 0) == 0 && !names_loss(messages, saved - taken, taken)) {
    result_.wrong += std::to_string(saved - taken) + " lost records are not named (" + messages.substr(0, 300) + "); ";
  }
}

}  // namespace kith::faults
