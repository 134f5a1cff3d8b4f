#pragma once

#include <string>

#include "room_state.hpp"

namespace kith {

/// Changes a state as events demand, and takes every step of the group that follows from it.
class RoomStepper {
 public:
  RoomStepper(const LiveStudy& study, const RoomSetup& setup, Room::State& state, TeachingCache& cache,
              std::int64_t at_us)
      : study_{study}, setup_{setup}, state_{state}, cache_{cache}, at_us_{at_us} {}

  /// Brings the session to who has a place now, and goes as far as possible: to where people, the teacher or the clock
  /// have to do something.
  void settle();

  void begin();                                                  ///< The lobby is over.
  void take_lesson(const TaughtLesson& lesson);                  ///< The teacher has chosen.
  void finish_phase(std::size_t seat);                           ///< The time of the phase is over for a seat.
  void give_answers(std::size_t seat);                           ///< All tests, or those that were answered in time.
  void begin_questions(const std::string& reason);               ///< Teaching is over.
  void examine(std::size_t seat);                                ///< The next board of the exam, if there is one.
  void end(const std::string& reason, const std::string& text);  ///< Early, for everybody.

  /// A seat leaves its place for good. @param page  what they see from now on.
  void dismiss(std::size_t seat, const std::string& page, const std::string& why, bool gets_code);
  /// A new seat with a simulated learner takes a place.
  void seat_stand_in(std::size_t member, char type);

 private:
  void sync_members();
  void revert();
  void advance();
  void begin_phase(RoomPhase phase);
  void begin_watching();
  void begin_tests();
  void begin_discussion();
  void make_board();
  [[nodiscard]] std::optional<GivenPath> path_of(std::size_t member, std::size_t test) const;
  void finish_discussion();
  void finish_tests();
  void record_answers();
  void record_curves();
  [[nodiscard]] bool all_done() const;

  const LiveStudy& study_;
  const RoomSetup& setup_;
  Room::State& state_;
  TeachingCache& cache_;
  std::int64_t at_us_;
};

/// The simulated learner of a member. @param is_first  from the beginning: then it is the learner of the simulated
/// team with the same address.
[[nodiscard]] std::shared_ptr<const Learner> make_stand_in(const LiveStudy& study, const RoomSetup& setup,
                                                           std::size_t member, char type, bool is_first,
                                                           TeachingCache& cache);

}  // namespace kith
