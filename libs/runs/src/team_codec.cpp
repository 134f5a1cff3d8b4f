#include "kith/runs/team_codec.hpp"

#include <concepts>
#include <cstddef>
#include <stdexcept>
#include <type_traits>

#include "kith/files/bytes.hpp"
#include "kith/files/sha256.hpp"

namespace kith {
namespace {

constexpr char kVersion = 8;  // of the layout; another layout gets another number
constexpr char kOldest = 7;   // that is read: it only says whether a team was complete
constexpr std::size_t kChecksumSize = 8;

std::string checksum(std::size_t team, std::string_view content, std::string_view key) {
  ByteWriter number;
  number.count(team);
  Sha256 hash;
  hash.update(key);
  hash.update(number.bytes());
  hash.update(content);
  return std::move(hash).digest().substr(0, kChecksumSize);
}

// Constant for a writer, not for a reader.
template <typename X, typename Part>
concept Is = std::same_as<std::remove_const_t<X>, Part>;

// Every part of a record once, in order, for the writer and the reader alike: what is written is what is read.
template <typename Coder, Is<LearnerRecord> X>
void code(Coder& coder, X& x) {
  coder.count(x.member);
  coder.letter(x.type);
  coder.reals(x.traits);
  coder.real(x.p_bec);
  coder.count(x.periods);
  coder.count(x.tests);
  coder.count(x.correct);
  coder.real(x.exam_share_right);
  coder.real(x.exam_regret);
  coder.count(x.exam_questions);
  coder.count(x.exam_correct);
}

template <typename Coder, Is<ExamRecord> X>
void code(Coder& coder, X& x) {
  coder.count(x.period);
  coder.count(x.component);
  coder.count(x.member);
  coder.letter(x.type);
  coder.real(x.share_right);
  coder.real(x.regret);
  coder.optional_real(x.p_bec);
}

template <typename Coder, Is<EstimateRecord> X>
void code(Coder& coder, X& x) {
  coder.count(x.period);
  coder.count(x.component);
  coder.count(x.member);
  coder.letter(x.type);
  for (auto* value : {&x.ability, &x.ability_mean, &x.ability_low, &x.ability_high, &x.p_proficient, &x.p_knew, &x.knew,
                      &x.p_right, &x.right}) {
    coder.optional_real(*value);
  }
}

template <typename Coder, Is<PeriodMastery> X>
void code(Coder& coder, X& x) {
  coder.real(x.predicted);
  coder.optional_real(x.actual);
}

template <typename Coder, Is<TeamExam> X>
void code(Coder& coder, X& x) {
  coder.real(x.share_right);
  coder.real(x.regret);
  coder.real(x.worst_share_right);
}

template <typename Coder, Is<PeriodForecast> X>
void code(Coder& coder, X& x) {
  coder.real(x.periods_left);
  for (auto& probability : x.done_within) coder.real(probability);
}

template <typename Coder, Is<TeamForecast> X>
void code(Coder& coder, X& x) {
  coder.real(x.periods);
  coder.real(x.periods_low);
  coder.real(x.periods_high);
  coder.real(x.minutes);
  coder.real(x.minutes_low);
  coder.real(x.minutes_high);
}

template <typename Coder, Is<PeriodRecord> X>
void code(Coder& coder, X& x) {
  coder.count(x.period);
  coder.count(x.member);
  coder.count(x.session);
  coder.count(x.members);
  coder.count(x.component);
  coder.text(x.source);
  coder.count(x.demonstrations);
  coder.real(x.area_sr);
  coder.real(x.running_area_sr);
  coder.count(x.tests);
  coder.flag(x.all_correct);
  coder.count(x.excluded);
  coder.count(x.untested);
  coder.real(x.gain);
  coder.optional_part(x.forecast);
  coder.optional_part(x.mastery);
  coder.reals(x.p_bec);
}

template <typename Coder, Is<BeliefSnapshot> X>
void code(Coder& coder, X& x) {
  coder.count(x.period);
  coder.text(x.belief);
  coder.reals(x.points);
  coder.reals(x.weights);
}

template <typename Coder, Is<DemonstrationRecord> X>
void code(Coder& coder, X& x) {
  coder.count(x.period);
  coder.count(x.member);
  coder.count(x.component);
  coder.count(x.demonstration);
  coder.count(x.mdp);
  coder.count(x.start);
  coder.half_spaces(x.constraints);
}

template <typename Coder, Is<ResponseRecord> X>
void code(Coder& coder, X& x) {
  coder.count(x.period);
  coder.count(x.component);
  coder.count(x.test);
  coder.count(x.member);
  coder.count(x.mdp);
  coder.count(x.start);
  coder.flag(x.correct);
  coder.optional_real(x.regret);
  coder.optional_vector(x.answer);
  coder.half_spaces(x.constraints);
  coder.half_spaces(x.covered);
}

template <typename Coder, Is<ProgressRecord> X>
void code(Coder& coder, X& x) {
  coder.count(x.period);
  coder.count(x.component);
  coder.count(x.member);
  coder.letter(x.type);
  coder.optional_real(x.ability);
  coder.real(x.p_bec);
  coder.flag(x.all_correct);
}

template <typename Coder, Is<TeamRecord> X>
void code(Coder& coder, X& x) {
  coder.text(x.seed_address);
  coder.status(x.status);
  coder.count(x.periods);
  coder.count(x.demonstrations);
  coder.count(x.tests);
  coder.real(x.knowledge);
  coder.real(x.knowledge_min);
  coder.count(x.components_learned);
  coder.count(x.components_skipped);
  coder.real(x.area_sr);
  coder.count(x.cost.person_periods);
  coder.real(x.cost.minutes);
  coder.real(x.cost.person_minutes);
  coder.optional_part(x.forecast);
  coder.list(x.learners);
  coder.list(x.period_records);
  coder.list(x.beliefs);
  coder.list(x.demonstration_records);
  coder.list(x.responses);
  coder.list(x.progress);
  coder.list(x.exams);
  coder.list(x.estimates);
  coder.optional_part(x.exam);
  coder.optional_real(x.fewest_particles);
}

class Encoder {
 public:
  void count(std::uint64_t x) { writer_.count(x); }
  void letter(char x) { writer_.letter(x); }
  void real(double x) { writer_.real(x); }
  void flag(bool x) { writer_.flag(x); }
  void status(SessionStatus x) { writer_.letter(static_cast<char>(x)); }
  void text(const std::string& x) { writer_.text(x); }
  void reals(const std::vector<double>& x) { writer_.reals(x); }
  void optional_real(const std::optional<double>& x) {
    flag(x.has_value());
    if (x) real(*x);
  }
  template <typename Part>
  void optional_part(const std::optional<Part>& x) {
    flag(x.has_value());
    if (x) code(*this, *x);
  }
  void optional_vector(const std::optional<IntegerVector>& x) {
    flag(x.has_value());
    if (x) writer_.vector(*x);
  }
  void half_spaces(const std::vector<HalfSpace>& x) {
    count(x.size());
    for (const auto& half_space : x) writer_.vector(half_space.normal());
  }
  template <typename Part>
  void list(const std::vector<Part>& parts) {
    count(parts.size());
    for (const auto& part : parts) code(*this, part);
  }
  [[nodiscard]] std::string take() && { return std::move(writer_).take(); }

 private:
  ByteWriter writer_;
};

class Decoder {
 public:
  explicit Decoder(std::string_view bytes) : reader_{bytes}, version_{reader_.letter()} {}
  void count(std::size_t& x) { x = static_cast<std::size_t>(reader_.count()); }
  void letter(char& x) { x = reader_.letter(); }
  void real(double& x) { x = reader_.real(); }
  void flag(bool& x) { x = reader_.flag(); }
  void status(SessionStatus& x) {
    const char letter = reader_.letter();
    if (version_ == kOldest) {
      x = letter != 0 ? SessionStatus::kComplete : SessionStatus::kMaxPeriods;
    } else if (letter < 0 || letter > static_cast<char>(SessionStatus::kMaxPeriods)) {
      reader_.refuse();
    } else {
      x = static_cast<SessionStatus>(letter);
    }
  }
  void text(std::string& x) { x = reader_.text(); }
  void reals(std::vector<double>& x) { x = reader_.reals(); }
  void optional_real(std::optional<double>& x) {
    if (reader_.flag()) x = reader_.real();
  }
  template <typename Part>
  void optional_part(std::optional<Part>& x) {
    if (reader_.flag()) code(*this, x.emplace());
  }
  void optional_vector(std::optional<IntegerVector>& x) {
    if (reader_.flag()) x = reader_.vector();
  }
  void half_spaces(std::vector<HalfSpace>& x) {
    const auto n = reader_.length();
    for (std::size_t i = 0; i < n && reader_.ok(); ++i) add(x, reader_.vector());
  }
  template <typename Part>
  void list(std::vector<Part>& parts) {
    const auto n = reader_.length();
    for (std::size_t i = 0; i < n && reader_.ok(); ++i) code(*this, parts.emplace_back());
  }
  [[nodiscard]] bool all_read() const { return reader_.ok() && reader_.at_end(); }

 private:
  void add(std::vector<HalfSpace>& x, const IntegerVector& normal) {
    try {
      x.emplace_back(normal);
    } catch (const std::invalid_argument&) {  // no half-space has this normal
      reader_.refuse();
    }
  }

  ByteReader reader_;
  char version_;
};

}  // namespace

std::string seal_record(std::size_t team, std::string content, std::string_view key) {
  content += checksum(team, content, key);
  return content;
}

std::optional<std::string_view> unseal_record(std::size_t team, std::string_view bytes, std::string_view key) {
  if (bytes.size() < kChecksumSize) return std::nullopt;
  const auto content = bytes.substr(0, bytes.size() - kChecksumSize);
  if (checksum(team, content, key) != bytes.substr(content.size())) return std::nullopt;
  return content;
}

std::string encode_team(const TeamRecord& record, std::string_view key) {
  Encoder encoder;
  encoder.letter(kVersion);
  code(encoder, record);
  return seal_record(record.address.team, std::move(encoder).take(), key);
}

bool is_intact(std::size_t team, std::string_view bytes, std::string_view key) {
  if (bytes.empty() || bytes.front() < kOldest || bytes.front() > kVersion) return false;
  return unseal_record(team, bytes, key).has_value();
}

std::optional<TeamRecord> decode_team(const TeamAddress& address, std::string_view bytes, std::string_view key) {
  if (!is_intact(address.team, bytes, key)) return std::nullopt;
  Decoder decoder{bytes.substr(0, bytes.size() - kChecksumSize)};
  TeamRecord record;
  record.address = address;
  code(decoder, record);
  if (!decoder.all_read()) return std::nullopt;
  return record;
}

}  // namespace kith
