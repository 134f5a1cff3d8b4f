#include "question_words.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "lexicon.hpp"

namespace kith::detail {
namespace {

std::vector<std::string> sequence_of(const std::string& text) {
  std::istringstream stream{text};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::set<std::string> words_in(const std::string& text) {
  const auto words = sequence_of(text);
  return {words.begin(), words.end()};
}

}  // namespace

bool is_filler(const std::string& word) {
  static const std::set<std::string> kWords = words_in(
      // articles, pronouns, auxiliaries, prepositions
      "a an the it its he she they them his her him their this that these those you your i me my we us one ones "
      "does do did doing done is are am be been being was were will would should could can may might shall must "
      "has have had having there here then to of in at on from for by over through across into onto along toward "
      "towards inside upon around via if or so as which whether about out off "
      // questions that ask politely, or think aloud
      "tell show explain say describe give see know wonder wondering like please thanks thank hi hello hey well ok "
      "okay "
      "now kith just let curious understand interested want wants wanted wish need needs possible possibly true "
      // how and how often, which the answer tells
      "ever sometimes always often usually normally typically generally still even also too already eventually ahead "
      "all any some anywhere somewhere everywhere earth world's maybe perhaps much bit point next rather prefer "
      "prefers "
      "preferred instead sure while as during actually really quickly slowly simply possibly probably likely finally "
      // the robot, and what it does without saying what
      "robot robots machine vehicle agent go goes going went move moves moving moved take takes taking took make "
      "makes making made happen happens happening happened start starts cell cells choose chooses choosing use uses "
      "using walk walks walking drive drives driving drove travel travels travelling turn turns turning turned head "
      "heads heading try tries trying decide decides decided deciding get gets getting got keep keeps end ends "
      "act acts behave behaves way ways route routes direction place places spot spots square squares tile tiles area "
      "areas field fields patch patches location locations worlds case cases situation situations circumstances "
      "when where why what many how board");
  return kWords.count(word) != 0;
}

bool is_contact(const std::string& stem_of_word) {
  static const std::set<std::string> kStems = [] {
    std::set<std::string> stems;
    for (const auto& word :
         words_in("cross enter pass traverse leave drive walk run ride roll visit reach come climb "
                  "fall stop step touch disturb meet approach travel stand land halt stay steer climb")) {
      stems.insert(stem(word));
    }
    return stems;
  }();
  return kStems.count(stem_of_word) != 0;
}

bool denies(const std::string& word) {
  static const std::set<std::string> kWords = words_in(
      "not no never without cannot instead than avoid avoids avoiding avoided around bypass bypasses bypassing skip "
      "skips skipping past away refuse refuses ignore ignores ignoring clear nowhere dodge dodges evade evades");
  return kWords.count(word) != 0 || (word.size() > 3 && word.ends_with("n't"));
}

bool is_auxiliary(const std::string& word) {
  static const std::set<std::string> kWords =
      words_in("does do did is are was were will would can could may might should has have");
  return kWords.count(word) != 0;
}

bool speaks_of_value(const std::string& word) {
  static const std::set<std::string> kWords = words_in(
      "cost costs costing mind minds minding dislike dislikes hate hates fear fears afraid scared bad worse worst "
      "expensive costly dangerous harmful dear price penalty bother bothers punish punished punishes cheaper cheap "
      "detest detests unpleasant worth like likes liking love loves enjoy enjoys good better best valuable reward "
      "rewards rewarded rewarding gain gains prefer prefers rather useful beneficial value values weight care cares "
      "matter matters important think thinks feel feels anything something nothing outweigh outweighs");
  return kWords.count(word) != 0;
}

namespace {

struct Pattern {
  Question::Kind kind;
  std::vector<std::set<std::string>> words;  // alternatives at each place
  bool removes = false;
};

// "what|which cells|places" in words, alternatives between bars.
Pattern pattern(Question::Kind kind, const std::string& text, bool removes = false) {
  Pattern result{kind, {}, removes};
  for (auto word : sequence_of(text)) {
    std::replace(word.begin(), word.end(), '|', ' ');
    result.words.push_back(words_in(word));
  }
  return result;
}

const std::vector<Pattern>& patterns() {
  using Kind = Question::Kind;
  static const std::string kPlaces = "place|places|cell|cells|square|squares|spot|spots|tile|tiles|location|locations";
  static const std::string kCases =
      "world|worlds|case|cases|situation|situations|circumstance|circumstances|condition|conditions|occasion|occasions";
  static const std::vector<Pattern> kPatterns{
      pattern(Kind::kWhen, "when"),
      pattern(Kind::kWhen, "in|under|on what|which " + kCases),
      pattern(Kind::kWhen, "in how many " + kCases),
      pattern(Kind::kWhen, "at what|which point"),
      pattern(Kind::kWhen, "how often|frequently|likely|probable"),
      pattern(Kind::kWhen, "is|are there a|any|some " + kCases + " where|in|when"),
      pattern(Kind::kWhen, "is it possible|likely"),
      pattern(Kind::kWhen, "what makes|causes|leads"),
      pattern(Kind::kWhen, "what is|are the chance|chances|odds|probability"),
      pattern(Kind::kWhen, "what the chance|chances|odds|probability"),
      pattern(Kind::kWhen, "wonder|wondering|know|tell|see|say|ask if|whether"),
      pattern(Kind::kWhen, "tell me|us if|whether"),
      pattern(Kind::kWhen, "whether"),
      pattern(Kind::kWhere, "where"),
      pattern(Kind::kWhere, "at|on|in|over|through what|which " + kPlaces),
      pattern(Kind::kWhere, "what|which " + kPlaces),
      pattern(Kind::kWhy, "why"),
      pattern(Kind::kWhy, "how come"),
      pattern(Kind::kWhy, "what is the reason|point|purpose|idea"),
      pattern(Kind::kWhy, "what the reason|point|purpose|idea"),
      pattern(Kind::kWhy, "what reason"),
      pattern(Kind::kWhy, "for what|which reason|purpose"),
      pattern(Kind::kWhy, "reason|reasons"),
      pattern(Kind::kWhatIf, "what if"),
      pattern(Kind::kWhatIf, "what changes|happens|differs if|when|with|in|during|at"),
      pattern(Kind::kWhatIf, "what would|will change|happen|differ if|when|with"),
      pattern(Kind::kWhatIf, "what would|will it do if|when|with"),
      pattern(Kind::kWhatIf, "what does it do if|when"),
      pattern(Kind::kWhatIf, "what would|will the robot do if|when|with"),
      pattern(Kind::kWhatIf, "how would|will|does it|things change|differ|behave|act if|when|with"),
      pattern(Kind::kWhatIf, "would|will|does anything change|differ if|when|with"),
      pattern(Kind::kWhatIf, "what difference does|do|would|will", true),
      pattern(Kind::kWhatIf, "if"),
      pattern(Kind::kWhatIf, "suppose|supposing|imagine|assume|assuming"),
      pattern(Kind::kWhat, "what"),
      pattern(Kind::kWhat, "how does|would|will it|he|she get|go|drive|walk|move|travel|behave|act"),
      pattern(Kind::kWhat, "how does|would|will the robot get|go|drive|walk|move|travel|behave|act"),
      pattern(Kind::kWhat, "which way|direction|action|step|move|route|path|turn"),
      pattern(Kind::kWhether, "which is|one|costs|of"),
      pattern(Kind::kHowMuch, "how much"),
      pattern(Kind::kHowMuch, "how many"),
      pattern(Kind::kHowMuch,
              "how bad|good|expensive|costly|valuable|important|dangerous|harmful|high|strongly|strong|"
              "large|big|useful|terrible|unpleasant"),
      pattern(Kind::kHowMuch, "how does|would it|he|she feel|think|value"),
      pattern(Kind::kHowMuch, "how does|would the robot feel|think|value"),
  };
  return kPatterns;
}

bool fits(const Pattern& pattern, const std::vector<Token>& tokens, std::size_t begin) {
  if (begin + pattern.words.size() > tokens.size()) return false;
  for (std::size_t i = 0; i < pattern.words.size(); ++i) {
    const auto& token = tokens[begin + i];
    if (token.kind != Token::Kind::kWord || pattern.words[i].count(token.text) == 0) return false;
  }
  return true;
}

}  // namespace

std::optional<Opening> find_opening(const std::vector<Token>& tokens) {
  for (std::size_t begin = 0; begin < tokens.size(); ++begin) {
    const Pattern* best = nullptr;
    for (const auto& pattern : patterns()) {
      if (fits(pattern, tokens, begin) && (best == nullptr || pattern.words.size() > best->words.size()))
        best = &pattern;
    }
    if (best != nullptr) return Opening{best->kind, begin, begin + best->words.size(), best->removes};
  }
  return std::nullopt;
}

}  // namespace kith::detail
