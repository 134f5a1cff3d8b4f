#include "condition.hpp"

#include <algorithm>

namespace kith::detail {
namespace {

constexpr std::size_t kMaxNesting = 32;

std::optional<std::size_t> position(const std::vector<std::string>& names, const std::string& name) {
  const auto it = std::find(names.begin(), names.end(), name);
  return it == names.end() ? std::nullopt : std::optional{static_cast<std::size_t>(it - names.begin())};
}

std::vector<std::string> item_names(const FamilyMap& family_map) {
  std::vector<std::string> names;
  for (const Item& item : family_map.items) names.push_back(item.name);
  return names;
}

// Recursive descent over
//   any = all { "|" all } ; all = one { "&" one } ; one = "!" one | "(" any ")" | word [ ":" word ]
class Parser {
 public:
  // @pre `text` is the string that is the value.
  Parser(const TomlValue& value, const std::string& text, const Vocabulary& vocabulary, std::vector<Atom>& atoms,
         TomlReport& report)
      : value_{value}, text_{text}, vocabulary_{vocabulary}, atoms_{atoms}, report_{report} {}

  std::optional<Condition> run() {
    any();
    skip_spaces();
    if (!failed_ && at_ < text_.size()) fail(at_, 1, "expected '&', '|' or the end");
    return failed_ ? std::nullopt : std::optional{std::move(result_)};
  }

 private:
  void any() {
    all();
    while (!failed_ && accept('|')) {
      all();
      result_.steps.push_back({Condition::Op::kOr, 0});
    }
  }

  void all() {
    one();
    while (!failed_ && accept('&')) {
      one();
      result_.steps.push_back({Condition::Op::kAnd, 0});
    }
  }

  void one() {
    if (failed_) return;
    if (++nesting_ > kMaxNesting) return fail(at_, 1, "nested too deep");
    if (accept('!')) {
      one();
      result_.steps.push_back({Condition::Op::kNot, 0});
    } else if (accept('(')) {
      any();
      if (!failed_ && !accept(')')) fail(at_, 1, "expected ')'");
    } else {
      atom();
    }
    --nesting_;
  }

  void atom() {
    skip_spaces();
    const std::size_t begin = at_;
    const std::string kind = word();
    if (kind.empty()) return fail(begin, 1, "expected a condition such as leave:X, '!' or '('");
    std::string name;
    std::size_t name_at = at_;
    const bool named = at_ < text_.size() && text_[at_] == ':';
    if (named) {
      name_at = ++at_;
      name = word();
      if (name.empty()) return fail(name_at, 1, "expected a name after '" + kind + ":'");
    }
    if (const auto found = resolve(kind, begin, named, name, name_at)) {
      result_.steps.push_back({Condition::Op::kAtom, number_of(*found)});
    }
  }

  // The atom, or nothing after reporting why there is none.
  std::optional<Atom> resolve(const std::string& kind, std::size_t begin, bool named, const std::string& name,
                              std::size_t name_at) {
    const FamilyMap& family_map = vocabulary_.family_map;
    if (!named && kind == "action") return Atom{Atom::Kind::kAnyAction, 0};
    if (!named && kind == "exit") return action("exit", begin);
    if (!named && kind == "goal") return Atom{Atom::Kind::kAnyGoal, 0};
    if (kind == "action" && named) return action(name, name_at);
    if (kind == "leave" && named) return place(name, name_at, Atom::Kind::kLeaveTerrain, Atom::Kind::kLeaveStation);
    if (kind == "enter" && named) return place(name, name_at, Atom::Kind::kEnterTerrain, Atom::Kind::kEnterStation);
    if (kind == "carrying" && named)
      return look_up(name, name_at, item_names(family_map), Atom::Kind::kCarrying, "item");
    if (kind == "deliver" && named) return deliver(name, name_at);
    if (kind == "goal" && named) return look_up(name, name_at, family_map.goal_names, Atom::Kind::kGoal, "goal");
    static const std::vector<std::string> kKinds{"action", "leave", "enter", "carrying", "deliver", "goal", "exit"};
    if (position(kKinds, kind)) {
      fail(begin, kind.size(), named ? "'exit' takes no name" : "'" + kind + "' needs a name, as in " + kind + ":X");
    } else {
      fail_unknown(begin, kind, "condition", kKinds);
    }
    return std::nullopt;
  }

  std::optional<Atom> action(const std::string& name, std::size_t at) {
    std::vector<std::string> names;
    for (const Action a : vocabulary_.actions) names.push_back(all_action_names()[static_cast<std::size_t>(a)]);
    const bool needs_item = name == "pickup" || name == "dropoff";
    if (needs_item && !position(names, name) && !vocabulary_.family_map.absent.empty()) return never();
    if (const auto i = position(names, name)) {
      return Atom{Atom::Kind::kAction, static_cast<std::size_t>(vocabulary_.actions[*i])};
    }
    fail_unknown(at, name, "action", names);
    return std::nullopt;
  }

  std::optional<Atom> place(const std::string& name, std::size_t at, Atom::Kind terrain, Atom::Kind station) {
    const FamilyMap& family_map = vocabulary_.family_map;
    if (is_absent(name)) return never();
    if (const auto i = position(family_map.terrain_names, name)) return Atom{terrain, *i};
    if (const auto i = position(family_map.station_names, name)) return Atom{station, *i};
    std::vector<std::string> known = family_map.terrain_names;
    known.insert(known.end(), family_map.station_names.begin(), family_map.station_names.end());
    fail_unknown(at, name, "terrain or station", known);
    return std::nullopt;
  }

  std::optional<Atom> deliver(const std::string& name, std::size_t at) {
    const auto found = look_up(name, at, item_names(vocabulary_.family_map), Atom::Kind::kDeliver, "item");
    if (found && found->kind == Atom::Kind::kDeliver && vocabulary_.family_map.is_sound &&
        vocabulary_.family_map.items[found->index].destinations.empty() && !is_absent(name)) {
      fail(at, name.size(), "item '" + name + "' has no destination on the map");
      return std::nullopt;
    }
    return found;
  }

  std::optional<Atom> look_up(const std::string& name, std::size_t at, const std::vector<std::string>& known,
                              Atom::Kind kind, const std::string& what) {
    if (is_absent(name)) return never();
    if (const auto i = position(known, name)) return Atom{kind, *i};
    fail_unknown(at, name, what, known);
    return std::nullopt;
  }

  // Declared as not being on this map: the condition does not hold, instead of being an error.
  [[nodiscard]] bool is_absent(const std::string& name) const {
    return position(vocabulary_.family_map.absent, name).has_value();
  }
  std::optional<Atom> never() {
    result_.names_absent_things = true;
    return Atom{Atom::Kind::kNever, 0};
  }

  std::size_t number_of(const Atom& atom) {
    const auto it = std::find(atoms_.begin(), atoms_.end(), atom);
    if (it != atoms_.end()) return static_cast<std::size_t>(it - atoms_.begin());
    if (atoms_.size() == kMaxAtoms) {
      fail(0, text_.size(), "the conditions of a file may use at most 64 different terms");
      return 0;
    }
    atoms_.push_back(atom);
    return atoms_.size() - 1;
  }

  std::string word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_name_character(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  void skip_spaces() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n')) ++at_;
  }

  bool accept(char c) {
    skip_spaces();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  void fail(std::size_t offset, std::size_t length, const std::string& message) {
    if (!failed_) {
      report_.error("E0215", report_.document().inside(value_, offset, length), "bad condition: " + message);
    }
    failed_ = true;
  }

  void fail_unknown(std::size_t offset, const std::string& name, const std::string& what,
                    const std::vector<std::string>& known) {
    // A broken legend may lack the name; actions and kinds of conditions do not depend on it.
    const bool certain = vocabulary_.family_map.legend_is_sound || what == "action" || what == "condition";
    if (!failed_ && certain) {
      report_.error("E0216", report_.document().inside(value_, offset, name.size()),
                    "condition names an unknown " + what + " '" + name + "'", suggestion(name, known));
    }
    failed_ = true;
  }

  const TomlValue& value_;
  const std::string& text_;
  const Vocabulary& vocabulary_;
  std::vector<Atom>& atoms_;
  TomlReport& report_;
  Condition result_;
  std::size_t at_ = 0;
  std::size_t nesting_ = 0;
  bool failed_ = false;
};

}  // namespace

const std::vector<std::string>& all_action_names() {
  static const std::vector<std::string> kNames{"up", "down", "left", "right", "pickup", "dropoff", "exit"};
  return kNames;
}

namespace {

std::optional<FeatureThing> thing_of(const Atom& atom, const FamilyMap& family_map) {
  switch (atom.kind) {
    case Atom::Kind::kLeaveTerrain:
      return FeatureThing{"leave", "terrain", family_map.terrain_names[atom.index]};
    case Atom::Kind::kEnterTerrain:
      return FeatureThing{"enter", "terrain", family_map.terrain_names[atom.index]};
    case Atom::Kind::kLeaveStation:
      return FeatureThing{"leave", "station", family_map.station_names[atom.index]};
    case Atom::Kind::kEnterStation:
      return FeatureThing{"enter", "station", family_map.station_names[atom.index]};
    case Atom::Kind::kCarrying:
      return FeatureThing{"carrying", "item", family_map.items[atom.index].name};
    case Atom::Kind::kDeliver:
      return FeatureThing{"deliver", "item", family_map.items[atom.index].name};
    case Atom::Kind::kGoal:
      return FeatureThing{"goal", "goal", family_map.goal_names[atom.index]};
    case Atom::Kind::kAnyGoal:
      return FeatureThing{"goal", "goal", "goal"};
    case Atom::Kind::kAnyAction:
    case Atom::Kind::kAction:
    case Atom::Kind::kNever:
      break;
  }
  return std::nullopt;
}

}  // namespace

std::vector<FeatureThing> things_of(const Condition& condition, const std::vector<Atom>& atoms,
                                    const FamilyMap& family_map) {
  std::vector<std::vector<FeatureThing>> stack;
  for (const Condition::Step& step : condition.steps) {
    if (step.op == Condition::Op::kAtom) {
      const auto thing = thing_of(atoms[step.atom], family_map);
      stack.push_back(thing ? std::vector{*thing} : std::vector<FeatureThing>{});
    } else if (step.op == Condition::Op::kNot) {
      stack.back().clear();
    } else {
      const auto right = std::move(stack.back());
      stack.pop_back();
      stack.back().insert(stack.back().end(), right.begin(), right.end());
    }
  }
  return stack.empty() ? std::vector<FeatureThing>{} : std::move(stack.back());
}

bool Condition::holds(AtomMask mask) const {
  std::vector<bool> stack;
  for (const Step& step : steps) {
    if (step.op == Op::kAtom) {
      stack.push_back(((mask >> step.atom) & 1U) != 0);
    } else if (step.op == Op::kNot) {
      stack.back() = !stack.back();
    } else {
      const bool right = stack.back();
      stack.pop_back();
      stack.back() = step.op == Op::kAnd ? (stack.back() && right) : (stack.back() || right);
    }
  }
  return stack.back();
}

std::optional<Condition> ConditionReader::read(const TomlValue& value) {
  const auto text = read_string(value, "'when'", report_);
  if (!text) return std::nullopt;
  return Parser{value, *text, vocabulary_, atoms_, report_}.run();
}

}  // namespace kith::detail
