#include "admission.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/ip/address.hpp>
#include <utility>

namespace kith {

Admission::Place::Place(Place&& other) noexcept
    : from_{std::exchange(other.from_, nullptr)}, guest_{std::move(other.guest_)} {}

Admission::Place& Admission::Place::operator=(Place&& other) noexcept {
  std::swap(from_, other.from_);
  std::swap(guest_, other.guest_);
  return *this;
}

Admission::Place::~Place() {
  if (from_ == nullptr) return;
  const std::lock_guard lock{from_->mutex_};
  if (guest_->status == Guest::Status::kGone) return;
  --from_->sockets_;
  from_->forget(*guest_);
}

void Admission::Place::belongs_to(std::weak_ptr<ServerConnection> connection) {
  if (from_ == nullptr) return;
  const std::lock_guard lock{from_->mutex_};
  guest_->connection = std::move(connection);
}

void Admission::Place::renew() {
  if (from_ == nullptr) return;
  const std::lock_guard lock{from_->mutex_};
  if (guest_->status != Guest::Status::kGuest) return;
  auto& guests = from_->guests_[guest_->address];
  guests.splice(guests.end(), guests, guest_->at);
}

void Admission::Place::trust() {
  if (from_ == nullptr) return;
  const std::lock_guard lock{from_->mutex_};
  if (guest_->status != Guest::Status::kGuest) return;
  from_->forget(*guest_);
  guest_->status = Guest::Status::kTrusted;
}

// Of whom somebody has to give way; null: of nobody.
Admission::Guests* Admission::crowd_for(const std::string& address, bool counts_per_address) {
  const auto own = guests_.find(address);
  if (counts_per_address && own != guests_.end() && own->second.size() >= max_per_address_) return &own->second;
  if (sockets_ < max_sockets_) return nullptr;
  const auto largest = std::max_element(guests_.begin(), guests_.end(),
                                        [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
  return largest == guests_.end() ? nullptr : &largest->second;
}

Admission::Verdict Admission::enter(const std::string& address, bool counts_per_address, Place& place) {
  Place mine;
  Verdict verdict{.is_welcome = true};
  const std::lock_guard lock{mutex_};
  const auto key = counts_per_address ? address : std::string{};
  if (auto* crowd = crowd_for(key, counts_per_address)) {
    const auto out = crowd->front();
    verdict.gives_way = out->connection.lock();
    forget(*out);
    out->status = Guest::Status::kGone;
    --sockets_;
    ++turned_away_;
  } else if (sockets_ >= max_sockets_) {
    ++turned_away_;
    return {};
  }
  mine.guest_ = std::make_shared<Guest>();
  mine.guest_->address = key;
  auto& guests = guests_[key];
  mine.guest_->at = guests.insert(guests.end(), mine.guest_);
  ++sockets_;
  mine.from_ = this;
  place = std::move(mine);
  return verdict;
}

bool Admission::is_crowded() const {
  const std::lock_guard lock{mutex_};
  return 4 * sockets_ >= 3 * max_sockets_;
}

std::size_t Admission::num_sockets() const {
  const std::lock_guard lock{mutex_};
  return sockets_;
}

std::uint64_t Admission::num_turned_away() const {
  const std::lock_guard lock{mutex_};
  return turned_away_;
}

// The guest is one no more.
void Admission::forget(Guest& guest) {
  if (guest.status != Guest::Status::kGuest) return;
  const auto found = guests_.find(guest.address);
  found->second.erase(guest.at);
  if (found->second.empty()) guests_.erase(found);
}

std::string address_group(std::string_view text) {
  boost::system::error_code error;
  auto address = boost::asio::ip::make_address(std::string{text}, error);
  if (error || address.is_v4()) return std::string{text};
  const auto v6 = address.to_v6();
  if (v6.is_v4_mapped()) return boost::asio::ip::make_address_v4(boost::asio::ip::v4_mapped, v6).to_string();
  auto bytes = v6.to_bytes();
  std::fill(bytes.begin() + 8, bytes.end(), static_cast<unsigned char>(0));
  return boost::asio::ip::address_v6{bytes}.to_string() + "/64";
}

}  // namespace kith
