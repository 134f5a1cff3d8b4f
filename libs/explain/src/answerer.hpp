#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kith/explain/contrast.hpp"
#include "kith/explain/question.hpp"
#include "question_parser.hpp"
#include "scene.hpp"

namespace kith::detail {

// Answers one question. Each kind of question has a source of its own.
class Answerer {
 public:
  Answerer(const Atlas& atlas, const std::string& text, Question question)
      : atlas_{atlas},
        domain_{atlas.domain()},
        map_{domain_.map()},
        text_{text},
        question_{std::move(question)},
        scene_{atlas, text, question_} {}

  Reply reply();

 private:
  // The last world of those that the question is about, or of all if it is about none.
  [[nodiscard]] MdpIndex last_world() const {
    for (auto m = domain_.num_mdps(); m-- > 0;) {
      if (scene_.is_asked_about(MdpIndex{m})) return MdpIndex{m};
    }
    return MdpIndex{domain_.num_mdps() - 1};
  }
  [[nodiscard]] std::string worlds_text(std::size_t n, std::size_t of) const;

  [[nodiscard]] std::string start() const { return map_ ? "the map's start" : "the first state"; }
  // Where "in 6 of 16 worlds" is about.
  [[nodiscard]] std::string from_the_start() const;
  [[nodiscard]] std::string on_the_way() const;

  // --- the question in words --------------------------------------------------
  // "stop at the charger"; nothing for features without a verb.
  [[nodiscard]] std::string verb_of(const Happening& happening) const;
  // "does it stop at the charger", "does a stair not happen".
  [[nodiscard]] std::string does(const Happening& happening, bool negated) const;

  // --- chances ----------------------------------------------------------------
  enum class Happens : std::uint8_t { kNo, kMaybe, kYes };

  // "stopping at the charger happens", "falling into the water can happen", "it does not go up".
  [[nodiscard]] std::string says_that(const Happening& happening, Happens how) const;

  // How it goes in one world: whether it happens, at which step of the path shown, and with which chance.
  struct World {
    std::optional<StartIndex> start;  // nothing: the robot is never there
    bool happens = false;             // or can happen
    std::optional<std::size_t> step;  // of the path shown
    std::optional<double> chance;     // where chance has a part in it
    [[nodiscard]] Happens how() const { return !happens ? Happens::kNo : chance ? Happens::kMaybe : Happens::kYes; }
  };

  [[nodiscard]] World look_at(std::optional<StartIndex> start) const;

  // ", with a chance of 18 %", "... of at most 18 %"; nothing where it is certain.
  [[nodiscard]] static std::string chance_text(const World& world, bool at_most = false);

  [[nodiscard]] static std::string it_does(const World& world);

  // Why there is nothing to show beside it: no way on which it happens more often (or less).
  [[nodiscard]] std::string nothing_else(MdpIndex world, const Happening& happening, bool happens) const;

  // "it would rather ...: ...", or why there is nothing to compare.
  [[nodiscard]] std::string because(const std::optional<Contrast>& contrast, const std::string& nothing) const;

  [[nodiscard]] bool has_several(const Contrast& contrast) const;

  // What a detour would add and leave out.
  [[nodiscard]] std::string detour(const Contrast& contrast) const;

  void show(StartIndex start_index, std::string text, const std::optional<Contrast>& contrast = std::nullopt,
            std::optional<std::size_t> step = std::nullopt);

  // --- when -------------------------------------------------------------------
  void when();

  void when_in(MdpIndex number);

  // The same in all worlds: the one with everything tells why, or the first that can.
  void when_alike(const std::vector<World>& worlds);

  // Two worlds that differ in little and in whether it happens.
  struct Pair {
    std::size_t num_groups, num_cells, num_present, yes, no;
    auto operator<=>(const Pair&) const = default;
  };

  [[nodiscard]] std::vector<Pair> neighbours(const std::vector<World>& worlds) const;

  // Of a sample of all possible worlds none may be neighbours.
  [[nodiscard]] std::vector<Pair> all_pairs(const std::vector<World>& worlds) const;

  // Each pair tells something new. Pairs whose reasons compare with detours only where there are no others.
  void when_differing(const std::vector<World>& worlds);

  std::size_t show_pairs(const std::vector<World>& worlds, const std::vector<Pair>& pairs, bool with_detours);

  void show_one_of_pair(const World& world, const std::optional<Contrast>& contrast, const std::string& why,
                        const std::string& differs);

  // ", with the charger at (4,1)"; nothing where a list of things would only confuse.
  [[nodiscard]] std::string difference(MdpIndex from, MdpIndex to) const;

  void show_world(const World& world);

  // --- where ------------------------------------------------------------------
  using Spot = std::pair<std::optional<Cell>, std::string>;  // the name of a state that is on no map

  [[nodiscard]] Spot spot_of(MdpIndex world, StateIndex s) const;

  // Where something happens on the ways from the start, or, if the question is negated, where the robot comes by and it
  // does not.
  struct Place {
    std::size_t worlds = 0;   // in which it does (not)
    std::size_t visited = 0;  // worlds in which the robot comes by
    StartIndex start;
    std::size_t step = 0;
    std::string text;  // "at (2,1)"
  };

  void add_places(MdpIndex world, std::map<Spot, Place>& places) const;

  void where();

  // "at (4,1) in 16 of 64 worlds", "(3,2) in 2 of 64 worlds"; of many the first ones.
  [[nodiscard]] std::vector<std::string> place_texts(const std::vector<Place>& places) const;

  // --- why --------------------------------------------------------------------
  void why();

  // "Why does it go left rather than go up at (2,1)?", "Why does it not stop at the charger?".
  [[nodiscard]] std::string why_in_words() const;

  // About one step.
  void why_at(StartIndex start_index);

  // About the path from the map's start.
  void why_path();

  // The world that explains best why something happens (or not): among those in which it is so, one in which the robot
  // weighs the fewest features against each other.
  [[nodiscard]] MdpIndex world_to_explain(bool happens) const;

  void conclude(StartIndex start, const std::string& says, const std::optional<Contrast>& contrast,
                const std::string& nothing = "it has no other choice");

  // --- what -------------------------------------------------------------------
  void what();
  void what_on_the_way(StartIndex start);

  // --- what if ----------------------------------------------------------------
  void what_if();

  // The world that a question changes which names none: that with the most things in it, or the barest, among those
  // that can be changed as it asks.
  [[nodiscard]] MdpIndex world_to_change(bool removes) const;
  // The world that is like `base` except for what the question asks. @throws kith::Error (E1108) if there is none.
  [[nodiscard]] MdpIndex world_with(MdpIndex base) const;

  // In how many pairs of worlds that differ in what was asked the paths differ, and the pair nearest to the given one.
  struct Effects {
    std::size_t tried = 0, matters = 0;
    MdpIndex base, world;
  };

  [[nodiscard]] Effects worlds_it_matters_in(MdpIndex base, MdpIndex world) const;

  // --- how much ---------------------------------------------------------------
  // What people can conclude about a feature's weight from all that the robot does, each with a demonstration.
  void how_much();

  // --- whether ----------------------------------------------------------------
  // Whether a statement about its reward holds, by what it does.
  void whether();

  // "if coming home is worth something, 16 steps cost more than falling into the water".
  [[nodiscard]] std::string statement_text(const HalfSpace& said) const;

  // A demonstration that shows it; two if one alone does not.
  void show_why_true(const HalfSpace& said, const std::vector<HalfSpace>& known);

  // The shortest demonstration that conveys a constraint.
  [[nodiscard]] std::optional<StartIndex> demonstration_of(const HalfSpace& constraint) const;

  const Atlas& atlas_;
  const Domain& domain_;
  std::optional<GridMap> map_;  // there is one if the question names a cell
  const std::string& text_;
  Question question_;
  Scene scene_;
  Reply reply_;
};

[[nodiscard]] std::string first_upper(std::string text);

}  // namespace kith::detail
