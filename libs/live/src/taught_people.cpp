#include "kith/live/taught_people.hpp"

#include <algorithm>
#include <utility>

namespace kith {

void TaughtPeople::see(const Room& room) {
  if (!room.holds_session()) return;
  const auto& session = room.session();
  answered_.resize(session.num_members());
  for (std::size_t i = 0; i < answered_.size(); ++i) {
    if (!answered_[i] && session.has_answered(i)) answered_[i] = room.seat_of(i);
  }
  if (session.periods() == periods_.size()) return;
  for (std::size_t i = 0; i < answered_.size(); ++i) {
    if (!answered_[i]) answered_[i] = room.seat_of(i);
  }
  periods_.push_back(std::exchange(answered_, {}));
}

std::vector<TaughtPerson> TaughtPeople::all(const Room& room) const {
  std::vector<TaughtPerson> people;
  const auto& session = room.session();
  for (std::size_t member = 0; member < session.num_members(); ++member) {
    const auto first = static_cast<std::ptrdiff_t>(people.size());
    const auto person_in = [&](std::size_t seat) -> TaughtPerson& {
      const auto found =
          std::find_if(people.begin() + first, people.end(), [&](const auto& one) { return one.seat == seat; });
      if (found != people.end()) return *found;
      return people.emplace_back(TaughtPerson{member, seat, room.is_person(seat), {}});
    };
    for (auto& period : observed_periods(session.history(), member)) {
      const auto seat = periods_.at(period.period - 1).at(member);
      if (seat) person_in(*seat).periods.push_back(std::move(period));
    }
    if (const auto seat = room.seat_of(member)) person_in(*seat);
  }
  for (auto& person : people) {
    const auto& boards = room.exam_of(person.seat);
    if (!person.periods.empty()) person.periods.insert(person.periods.end(), boards.begin(), boards.end());
  }
  return people;
}

}  // namespace kith
