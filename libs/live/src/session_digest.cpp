#include <string>

#include "kith/files/bytes.hpp"
#include "kith/files/sha256.hpp"
#include "kith/live/teaching_task.hpp"

namespace kith {
namespace {

class SessionBytes {
 public:
  explicit SessionBytes(const Session& session) : session_{session} {}

  std::string take() && {
    bytes_.text(session_.strategy().name);
    bytes_.count(static_cast<std::uint64_t>(session_.status()));
    bytes_.count(static_cast<std::uint64_t>(session_.phase()));
    for (const auto component : session_.components()) bytes_.count(static_cast<std::uint64_t>(component));
    for (std::size_t m = 0; m < session_.num_members(); ++m) {
      bytes_.flag(session_.takes_part(m));
      bytes_.flag(session_.has_answered(m));
    }
    half_spaces(session_.taught_region());
    bytes_.count(session_.periods());
    for (const auto& past : session_.history()) {
      lesson(past.lesson);
      for (const auto& list : past.answers) answers(list);
      feedback(past.feedback);
      for (const auto& list : past.revised) answers(list);
    }
    if (session_.has_discussed()) bytes_.flag(true);
    if (session_.phase() != SessionPhase::kProposal && session_.phase() != SessionPhase::kFinished) {
      lesson(session_.lesson());
    }
    beliefs();
    return std::move(bytes_).take();
  }

 private:
  void half_spaces(std::span<const HalfSpace> list) {
    bytes_.count(list.size());
    for (const auto& half_space : list) bytes_.vector(half_space.normal());
  }
  void answers(const std::vector<Answer>& list) {
    bytes_.count(list.size());
    for (const auto& answer : list) {
      bytes_.flag(answer.has_value());
      if (answer) bytes_.vector(*answer);
    }
  }
  void lesson(const Lesson& lesson) {
    bytes_.count(lesson.period);
    bytes_.count(lesson.component);
    bytes_.text(lesson.source.rule);
    bytes_.count(lesson.source.member);
    bytes_.count(lesson.demonstrations.size());
    for (const auto& shown : lesson.demonstrations) {
      bytes_.count(shown.start.value());
      half_spaces(shown.half_spaces);
      bytes_.real(shown.gain);
    }
    half_spaces(lesson.taught);
    bytes_.count(lesson.tests.size());
    for (const auto& test : lesson.tests) {
      bytes_.count(test.start.value());
      half_spaces(test.covered);
    }
    bytes_.flag(lesson.repeats);
    bytes_.real(lesson.area_sr);
    bytes_.real(lesson.running_area_sr);
  }
  void feedback(const Feedback& feedback) {
    for (const auto& list : feedback.verdicts) {
      bytes_.count(list.size());
      for (const auto& verdict : list) {
        bytes_.flag(verdict.correct);
        bytes_.flag(verdict.answered);
        bytes_.real(verdict.regret);
        half_spaces(verdict.half_spaces);
      }
    }
    bytes_.flag(feedback.component_learned);
  }
  void belief(const ParticleBelief& belief) {
    bytes_.count(belief.size());
    for (std::size_t k = 0; k < belief.dimension(); ++k) {
      for (const double x : belief.axis(k)) bytes_.real(x);
    }
    for (const double weight : belief.weights()) bytes_.real(weight);
  }
  void beliefs() {
    const auto& team = session_.belief();
    if (team.options().members || team.num_members() == 1) {
      for (std::size_t m = 0; m < team.num_members(); ++m) belief(team.member(m));
    }
    for (const auto& rule : team.options().rules) belief(team.aggregate(rule.name));
  }

  const Session& session_;
  ByteWriter bytes_;
};

}  // namespace

std::string digest_of(const Session& session) { return sha256(SessionBytes{session}.take()); }

}  // namespace kith
