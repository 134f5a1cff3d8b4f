#include "admission.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/ip/address.hpp>
#include <utility>

namespace kith {

Admission::Place::Place(Place&& other) noexcept
    : from_{std::exchange(other.from_, nullptr)}, address_{std::move(other.address_)} {}

Admission::Place& Admission::Place::operator=(Place&& other) noexcept {
  std::swap(from_, other.from_);
  std::swap(address_, other.address_);
  return *this;
}

Admission::Place::~Place() {
  if (from_ != nullptr) from_->leave(address_);
}

void Admission::Place::trust() {
  if (from_ == nullptr || address_.empty()) return;
  const std::lock_guard lock{from_->mutex_};
  from_->forget(address_);
  address_.clear();
}

Admission::Verdict Admission::enter(const std::string& address, bool counts_per_address, Place& place) {
  Place mine;
  const std::lock_guard lock{mutex_};
  if (sockets_ >= max_sockets_) {
    ++turned_away_;
    return Verdict::kTooMany;
  }
  if (counts_per_address && !address.empty()) {
    auto& unknown = unknown_[address];
    if (unknown >= max_per_address_) {
      ++turned_away_;
      return Verdict::kTooManyOfAddress;
    }
    mine.address_ = address;
    ++unknown;
  }
  ++sockets_;
  mine.from_ = this;
  place = std::move(mine);
  return Verdict::kWelcome;
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

void Admission::leave(const std::string& address) {
  const std::lock_guard lock{mutex_};
  --sockets_;
  forget(address);
}

void Admission::forget(const std::string& address) {
  const auto found = unknown_.find(address);
  if (found != unknown_.end() && --found->second == 0) unknown_.erase(found);
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
