// Questions as people ask them, and sentences as kith prints them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "atlases.hpp"
#include "kith/core/error.hpp"
#include "kith/explain/curriculum.hpp"
#include "kith/explain/question.hpp"
#include "kith/explain/target.hpp"
#include "kith/explain/words.hpp"

namespace kith {
namespace {

using testing::atlas_of;
using ::testing::HasSubstr;

const std::string kQuestions = std::string{KITH_SOURCE_DIR} + "/libs/explain/tests/questions/";

struct Asked {
  std::string domain, meant, question;
  bool may_be_refused = false;
};

std::string file_of(const std::string& domain) {
  if (domain == "hospital") return kQuestions + "hospital.toml";
  if (domain == "cliff") return std::string{KITH_SOURCE_DIR} + "/docs/examples/cliff.toml";
  if (domain == "icy-crossing") return std::string{KITH_SOURCE_DIR} + "/domains/icy_crossing.toml";
  return domain;
}

std::vector<Asked> all_asked() {
  std::ifstream file{kQuestions + "asked.txt"};
  std::vector<Asked> all;
  Asked next;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    if (line.front() == '@') {
      next.domain = file_of(line.substr(2));
    } else if (line.front() == '=') {
      next.meant = line.substr(2);
    } else {
      next.may_be_refused = line.front() == '!';
      next.question = next.may_be_refused ? line.substr(2) : line;
      all.push_back(next);
    }
  }
  return all;
}

// The question as it was understood; nothing if it was refused, with a word or a reason.
std::optional<std::string> understood(const std::string& domain, const std::string& question, std::string& why) {
  try {
    return answer_question(atlas_of(domain), question).question;
  } catch (const Error& error) {
    const auto& d = error.diagnostics().at(0);
    why = d.id + " " + d.message + " | " + d.hint;
    EXPECT_EQ(d.file, "question") << question;
    EXPECT_FALSE(d.hint.empty() && d.remedy == Remedy::kNone) << question << ": " << why;
    return std::nullopt;
  }
}

// Wrong answers are worse than none: a question is answered as it was meant, or refused.
TEST(Asked, InOwnWordsNineOfTenAreAnsweredAndNoneWrongly) {
  const auto all = all_asked();
  ASSERT_GE(all.size(), 200u);
  std::size_t answered = 0;
  for (const auto& one : all) {
    std::string why;
    const auto question = understood(one.domain, one.question, why);
    if (question) {
      EXPECT_EQ(*question, one.meant) << one.question;
      ++answered;
    } else {
      EXPECT_TRUE(one.may_be_refused) << one.question << ": " << why;
    }
  }
  EXPECT_GE(10 * answered, 9 * all.size()) << answered << " of " << all.size();
}

// Wherever a word stands that nobody knows, a question is refused: every word is read.
TEST(Asked, WithAnUnknownWordAnywhereAreRefused) {
  std::size_t asked = 0;
  for (const auto& one : all_asked()) {
    if (one.may_be_refused) continue;
    for (auto at = one.question.find(' ');; at = one.question.find(' ', at + 1)) {
      std::string why;
      const auto other =
          one.question.substr(0, at) + " zebra" + (at == std::string::npos ? "" : one.question.substr(at));
      EXPECT_FALSE(understood(one.domain, other, why)) << other;
      ++asked;
      if (at == std::string::npos) break;
    }
  }
  EXPECT_GE(asked, 1000u);
}

// All sentences of a lesson.
std::set<std::string> taught(const Atlas& atlas) {
  const auto& domain = atlas.domain();
  std::set<std::string> all;
  const auto add = [&](const std::vector<HalfSpace>& constraints) {
    for (const auto& text : each_in_words(domain, constraints)) all.insert(text);
  };
  add(atlas.policy_bec_half_spaces());
  for (const auto& component : make_curriculum(atlas).components) {
    add(component.constraints);
    for (const auto& shown : component.demonstrations) add(shown.conveys);
    for (const auto& test : component.tests) add(test.covers);
  }
  all.erase("");
  return all;
}

// Those of some constraints by themselves.
std::set<std::string> single(const Atlas& atlas) {
  constexpr std::size_t kSome = 60;
  std::set<std::string> all;
  const auto& domain = atlas.domain();
  const auto& table = atlas.constraints();
  for (std::size_t i = 0; i < std::min(kSome, table.size()); ++i) {
    all.insert(in_words(domain, table[ConstraintIndex{i * table.size() / std::min(kSome, table.size())}]));
  }
  all.erase("");
  return all;
}

class Printed : public ::testing::TestWithParam<std::string> {};

// What kith prints it takes: no sentence is foreign to `find` and `ask`, whatever they answer.
TEST_P(Printed, SentencesAreUnderstood) {
  const auto& atlas = atlas_of(GetParam());
  const auto lesson = taught(atlas);
  // Where every choice weighs three things against each other there is nothing short to say.
  EXPECT_EQ(lesson.empty(), GetParam() == "two-goals");
  for (const auto& sentence : lesson) {
    EXPECT_THAT(answer_question(atlas, sentence).text, ::testing::StartsWith("Yes")) << sentence;
  }
  auto sentences = single(atlas);
  sentences.insert(lesson.begin(), lesson.end());
  for (const auto& sentence : sentences) {
    EXPECT_THAT(answer_question(atlas, sentence).text, ::testing::Not(::testing::StartsWith("No"))) << sentence;
    try {
      static_cast<void>(parse_constraint(atlas, sentence));
    } catch (const Error& error) {
      EXPECT_EQ(error.diagnostics().at(0).id, "E1110") << sentence << ": known beforehand, not unknown";
      EXPECT_THAT(error.what(), HasSubstr("beforehand")) << sentence;
    }
  }
}

std::vector<std::string> all_domains() {
  std::vector<std::string> names;
  for (const auto& domain : built_in_domains()) {
    if (domain.name != "warehouse") names.emplace_back(domain.name);  // the largest
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, Printed, ::testing::ValuesIn(all_domains()),
                         [](const auto& domain) { return std::to_string(domain.index); });

}  // namespace
}  // namespace kith
