// What people who are taught read, of every domain that is built in or in the gallery: told.txt. With KITH_TOLD the
// file that it names is written anew, to be read by somebody.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "atlases.hpp"
#include "discounted_domains.hpp"
#include "kith/explain/curriculum.hpp"
#include "kith/explain/curriculum_json.hpp"
#include "kith/explain/words.hpp"

namespace kith {
namespace {

using testing::atlas_of;

const std::string kToldSource = KITH_SOURCE_DIR;

std::string told_file(const std::string& path) {
  std::ifstream in{kToldSource + path};
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// A text's sentences: what ends with a full stop, a colon or a semicolon.
std::vector<std::string> told_sentences(const std::string& text) {
  std::vector<std::string> all;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_end =
        std::string{".:;!?"}.find(text[i]) != std::string::npos && (i + 1 == text.size() || text[i + 1] == ' ');
    if (!is_end && i + 1 < text.size()) continue;
    all.push_back(text.substr(begin, i + 1 - begin));
    begin = i + 2;
  }
  return all;
}

class Told {
 public:
  void add_lesson(const Atlas& atlas) {
    lines_ += (lines_.empty() ? "# " : "\n# ") + atlas.domain().id() + "\n";
    said_.clear();
    add(job_in_words(atlas.domain()));
    const auto json = curriculum_json(atlas, make_curriculum(atlas), 1, "kith");
    for (const auto& component : json["components"]) {
      for (const auto& shown : component["demonstrations"]) {
        add(shown["reason"].get<std::string>());
        add_texts(shown["conveys"]);
        add_texts(shown["brackets"]);
      }
      for (const auto& test : component["tests"]) add_texts(test["covers"]);
      add_texts(component["sentences"]);
    }
    if (!json["endless"].is_null()) add("from here " + json["endless"]["repeats_text"].get<std::string>());
  }
  [[nodiscard]] const std::string& lines() const { return lines_; }

 private:
  void add(const std::string& text) {
    for (const auto& sentence : told_sentences(text)) {
      if (!sentence.empty() && said_.insert(sentence).second) lines_ += sentence + "\n";
    }
  }
  void add_texts(const nlohmann::json& all) {
    for (const auto& one : all) add(one["text"].get<std::string>());
  }

  std::string lines_;
  std::set<std::string> said_;
};

int words_in(const std::string& sentence) {
  return 1 + static_cast<int>(std::count(sentence.begin(), sentence.end(), ' '));
}

// Short, in whole numbers, without places.
void expect_form(const std::string& sentence) {
  SCOPED_TRACE(sentence);
  EXPECT_LE(words_in(sentence), kMostWords);
  EXPECT_EQ(sentence.find('('), std::string::npos);
  for (std::size_t i = 0; i + 1 < sentence.size(); ++i) {
    const bool is_decimal = sentence[i] == '.' && std::isdigit(static_cast<unsigned char>(sentence[i + 1])) != 0;
    EXPECT_FALSE(is_decimal);
  }
}

TEST(Told, IsWhatTheFileSays) {
  Told told;
  for (const auto& domain : built_in_domains()) told.add_lesson(atlas_of(std::string{domain.name}));
  std::vector<std::string> gallery;
  for (const auto& entry : std::filesystem::directory_iterator{kToldSource + "/domains/gallery"})
    if (entry.path().extension() == ".toml") gallery.push_back(entry.path());
  std::sort(gallery.begin(), gallery.end());
  for (const auto& file : gallery) told.add_lesson(atlas_of(file));
  told.add_lesson(Atlas{testing::discounted_domain("item-delivery", 0.9)});  // a robot that never ends

  if (const char* const file = std::getenv("KITH_TOLD")) std::ofstream{file} << told.lines();
  EXPECT_EQ(told.lines(), told_file("/libs/explain/tests/told.txt"));
}

TEST(Told, IsShortAndWhole) {
  std::istringstream lines{told_file("/libs/explain/tests/told.txt")};
  std::size_t n = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.front() == '#') continue;
    expect_form(line);
    ++n;
  }
  EXPECT_GT(n, 100u);
}

// What the pages say beside it, while somebody watches, predicts and compares.
TEST(Told, IsShortInTheTextsOfThePages) {
  for (const std::string language : {"en", "de"}) {
    const auto texts = nlohmann::json::parse(told_file("/web/src/shared/texts/" + language + ".json"));
    for (const auto& [key, text] : texts.items()) {
      const auto part = key.substr(0, key.find('.'));
      const std::vector<std::string> parts{"intro",   "check",    "watch",   "predict", "discuss", "feedback",
                                           "debrief", "brackets", "explore", "fan",     "say",     "board"};
      if (std::find(parts.begin(), parts.end(), part) == parts.end()) continue;
      for (const auto& sentence : told_sentences(text.get<std::string>()))
        EXPECT_LE(words_in(sentence), kMostWords) << key;
    }
  }
}

}  // namespace
}  // namespace kith
