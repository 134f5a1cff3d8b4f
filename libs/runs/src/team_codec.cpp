#include "kith/runs/team_codec.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <type_traits>

#include "kith/files/bytes.hpp"
#include "kith/files/sha256.hpp"
#include "kith/study/record_columns.hpp"

namespace kith {
namespace {

// Layouts of the records have numbers. RecordColumn::since says which members came with a later one.
constexpr int kFirst = 8;   // with the members that do not say since when
constexpr int kOldest = 7;  // that is read: it only says whether a team was complete
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

// Finds the newest layout: the latest since when there is a member.
class LayoutSearch {
 public:
  void column(auto /*member*/, const ColumnWords& /*words*/, const RecordColumn& options = {}) {
    found_ = std::max(found_, options.since);
  }
  template <typename Part, typename R>
  void part(Part R::* /*member*/, const RecordColumn& options = {}) {
    found_ = std::max(found_, options.since);
    search(columns::Declared<typename detail::CellType<Part>::Type>{});
  }
  template <typename Value, typename R>
  void kept(Value R::* /*member*/, int since = 0) {
    found_ = std::max(found_, since);
  }
  template <typename Record, typename R>
  requires std::is_class_v<Record>
  void kept(std::vector<Record> R::* /*member*/, int since = 0) {
    found_ = std::max(found_, since);
    search(columns::Declared<Record>{});
  }
  template <typename Record>
  void search(columns::Declared<Record> record) {
    declare(*this, record);
  }
  void columns(auto /*member*/, auto /*list*/, const RecordColumn& options = {}) {
    found_ = std::max(found_, options.since);
  }
  void traits(auto /*member*/) {}
  void derived(auto /*function*/, const ColumnWords& /*words*/, const RecordColumn& /*options*/ = {}) {}
  [[nodiscard]] int found() const noexcept { return found_; }

 private:
  int found_ = kFirst;
};

int newest_layout() {
  static const int kNewest = [] {
    LayoutSearch layouts;
    layouts.search(columns::Declared<TeamRecord>{});
    return layouts.found();
  }();
  return kNewest;
}

// Tells a coder about the members that declare() names, in order: what is written is what is read.
template <typename Coder, typename Record>  // constant for a writer
class Members {
 public:
  Members(Coder& coder, Record& record) : coder_{coder}, record_{record} {}

  void column(auto member, const ColumnWords& /*words*/, const RecordColumn& options = {}) {
    kept(member, options.since);
  }
  void columns(auto member, auto /*list*/, const RecordColumn& options = {}) { kept(member, options.since); }
  void part(auto member, const RecordColumn& options = {}) { kept(member, options.since); }
  void kept(auto member, int since = 0) {
    if (since <= coder_.layout()) coder_.value(record_.*member);
  }
  void traits(auto member) { coder_.value(record_.*member); }
  void derived(auto /*function*/, const ColumnWords& /*words*/, const RecordColumn& /*options*/ = {}) {}

 private:
  Coder& coder_;
  Record& record_;
};

class Encoder {
 public:
  explicit Encoder(int layout) : layout_{layout} {}
  [[nodiscard]] int layout() const noexcept { return layout_; }
  void value(std::size_t x) { writer_.count(x); }
  void value(char x) { writer_.letter(x); }
  void value(double x) { writer_.real(x); }
  void value(bool x) { writer_.flag(x); }
  void value(SessionStatus x) { writer_.letter(static_cast<char>(x)); }
  void value(const std::string& x) { writer_.text(x); }
  void value(const IntegerVector& x) { writer_.vector(x); }
  void value(const HalfSpace& x) { writer_.vector(x.normal()); }
  void value(const std::vector<double>& x) { writer_.reals(x); }
  template <std::size_t n>
  void value(const std::array<double, n>& x) {
    for (const double one : x) value(one);
  }
  template <typename Part>
  void value(const std::optional<Part>& x) {
    value(x.has_value());
    if (x) value(*x);
  }
  template <typename Part>
  void value(const std::vector<Part>& parts) {
    value(parts.size());
    for (const auto& part : parts) value(part);
  }
  template <typename Record>
  requires std::is_class_v<Record>
  void value(const Record& record) {
    Members<Encoder, const Record> members{*this, record};
    declare(members, columns::Declared<Record>{});
  }
  [[nodiscard]] std::string take() && { return std::move(writer_).take(); }

 private:
  ByteWriter writer_;
  int layout_;
};

class Decoder {
 public:
  explicit Decoder(std::string_view bytes) : reader_{bytes}, layout_{reader_.letter()} {}
  [[nodiscard]] int layout() const noexcept { return layout_; }

  void value(std::size_t& x) { x = static_cast<std::size_t>(reader_.count()); }
  void value(char& x) { x = reader_.letter(); }
  void value(double& x) { x = reader_.real(); }
  void value(bool& x) { x = reader_.flag(); }
  void value(SessionStatus& x) {
    const char letter = reader_.letter();
    if (layout_ == kOldest) {
      x = letter != 0 ? SessionStatus::kComplete : SessionStatus::kMaxPeriods;
    } else if (letter < 0 || letter > static_cast<char>(SessionStatus::kMaxPeriods)) {
      reader_.refuse();
    } else {
      x = static_cast<SessionStatus>(letter);
    }
  }
  void value(std::string& x) { x = reader_.text(); }
  void value(IntegerVector& x) { x = reader_.vector(); }
  void value(std::vector<double>& x) { x = reader_.reals(); }
  void value(std::vector<HalfSpace>& x) {
    const auto n = reader_.length();
    for (std::size_t i = 0; i < n && reader_.ok(); ++i) add(x, reader_.vector());
  }
  template <std::size_t n>
  void value(std::array<double, n>& x) {
    for (double& one : x) value(one);
  }
  template <typename Part>
  void value(std::optional<Part>& x) {
    if (reader_.flag()) value(x.emplace());
  }
  template <typename Part>
  void value(std::vector<Part>& parts) {
    const auto n = reader_.length();
    for (std::size_t i = 0; i < n && reader_.ok(); ++i) value(parts.emplace_back());
  }
  template <typename Record>
  requires std::is_class_v<Record>
  void value(Record& record) {
    Members<Decoder, Record> members{*this, record};
    declare(members, columns::Declared<Record>{});
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
  int layout_;
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

std::string encode_team(const TeamRecord& record, std::string_view key, std::optional<int> layout) {
  Encoder encoder{layout.value_or(newest_layout())};
  encoder.value(static_cast<char>(encoder.layout()));
  encoder.value(record);
  return seal_record(record.address.team, std::move(encoder).take(), key);
}

bool is_intact(std::size_t team, std::string_view bytes, std::string_view key) {
  if (bytes.empty() || bytes.front() < kOldest || bytes.front() > newest_layout()) return false;
  return unseal_record(team, bytes, key).has_value();
}

std::optional<TeamRecord> decode_team(const TeamAddress& address, std::string_view bytes, std::string_view key) {
  if (!is_intact(address.team, bytes, key)) return std::nullopt;
  Decoder decoder{bytes.substr(0, bytes.size() - kChecksumSize)};
  TeamRecord record;
  record.address = address;
  decoder.value(record);
  if (!decoder.all_read()) return std::nullopt;
  return record;
}

}  // namespace kith
