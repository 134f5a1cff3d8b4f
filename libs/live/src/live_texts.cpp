#include "live_texts.hpp"

#include <algorithm>

#include "kith/explain/words.hpp"

namespace kith {

void fill_in_texts(GroupOptions& group, const Domain& domain) {
  const auto explained = explained_to_people(domain);
  if (group.story.empty()) {
    group.story = {
        "A robot has a job to do and decides by itself how to do it. Some things cost it effort, others are worth a "
        "detour. " +
        std::string{explained.empty() ? "It" : "Here it"} + " always takes the path that is best for it."};
  }
  const bool is_said = std::ranges::find(group.story, explained) != group.story.end();
  if (!explained.empty() && !is_said && group.language.empty()) group.story.push_back(explained);
  if (group.goal.empty()) group.goal = "Find out how the robot decides what to do.";
  if (group.consent_text.empty() && group.consent_file.empty()) {
    group.consent_text = {
        "You will watch a simulated robot, answer questions about what it would do, and hear whether you were right.",
        "Taking part is voluntary. You may stop at any time without giving a reason."};
    if (group.dropout.policy == DropoutPolicy::kSimulate) {
      group.consent_text.emplace_back("If somebody in your group stops early, a computer program may take that place.");
    }
  }
}

std::string member_label(std::size_t member) {
  std::string letters;
  for (std::size_t n = member + 1; n > 0; n = (n - 1) / 26) {
    letters.insert(letters.begin(), static_cast<char>('A' + static_cast<char>((n - 1) % 26)));
  }
  return "Learner " + letters;
}

std::vector<std::string> paragraphs_of(std::string_view text) {
  std::vector<std::string> paragraphs;
  std::string paragraph;
  const auto finish = [&] {
    if (!paragraph.empty()) paragraphs.push_back(std::move(paragraph));
    paragraph.clear();
  };
  while (!text.empty()) {
    const auto end = text.find('\n');
    auto line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
    while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
    // A heading or an item of a list stands alone.
    const bool begins =
        !line.empty() && (line.front() == '#' || line.substr(0, 2) == "* " || line.substr(0, 2) == "- ");
    if (line.empty() || begins) finish();
    if (line.empty()) continue;
    if (!paragraph.empty()) paragraph += ' ';
    paragraph += line;
    if (line.front() == '#') finish();
  }
  finish();
  return paragraphs;
}

std::string sentence(std::string text) {
  if (text.empty()) return text;
  if (text.front() >= 'a' && text.front() <= 'z') text.front() = static_cast<char>(text.front() - 'a' + 'A');
  if (text.back() != '.' && text.back() != '!' && text.back() != '?') text += '.';
  return text;
}

}  // namespace kith
