#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "question_parser.hpp"

namespace kith::detail {

// What people can name in one domain, in any form of the word.
class Lexicon {
 public:
  explicit Lexicon(const Domain& domain);

  [[nodiscard]] bool knows(const std::string& word) const;
  // Whether a word names something to carry and no action or feature.
  [[nodiscard]] bool is_only_item(const std::string& word) const;
  // Whether a word names something by itself: no verb that only says that the robot has to do with it.
  [[nodiscard]] bool names_something(const std::string& word) const;
  // What words together name: what every one of them can mean, verbs only as far as they leave anything. A whole name
  // wins over words about it.
  [[nodiscard]] std::vector<Happening> happenings(const std::vector<std::string>& words) const;
  [[nodiscard]] std::string name_of(const Happening& happening) const;
  // All actions and features.
  [[nodiscard]] std::vector<std::string> happening_names() const;
  // Words to suggest for one that is not known.
  [[nodiscard]] std::vector<std::string> all_words() const;
  // Whether a word is a verb without a meaning of its own in this domain: "enter".
  [[nodiscard]] bool says_only_contact(const std::string& word) const;

  // The optional thing of this name.
  [[nodiscard]] std::optional<std::string> optional_thing(const std::string& word) const;
  [[nodiscard]] std::vector<std::string> optional_things() const;

 private:
  [[nodiscard]] bool is_item(const std::string& stem_of_word) const;
  void add_words(const std::string& text, std::size_t feature);
  void add_things(std::size_t feature);
  // What a word of these stems means together, and which actions and features that leaves.
  [[nodiscard]] std::set<std::size_t> common_meanings(const std::vector<std::string>& stems) const;
  [[nodiscard]] bool is_weak(const std::string& stem_of_word) const;
  [[nodiscard]] bool has_action(const std::string& name) const;
  // The stem of a word, or of a synonym that the domain has where it does not have the word itself.
  [[nodiscard]] std::string known_stem(const std::string& word) const;

  const Domain& domain_;
  std::map<std::string, std::set<std::size_t>> meanings_;  // by stem; features, then actions
  std::set<std::string> verbs_;                            // stems: how the words of features begin
  std::vector<std::string> words_;
};

}  // namespace kith::detail
