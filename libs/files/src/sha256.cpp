#include "kith/files/sha256.hpp"

#include <openssl/evp.h>

#include <array>

#include "kith/core/assert.hpp"

namespace kith {

struct Sha256::State {
  State() : context{EVP_MD_CTX_new()} { KITH_ASSERT(context != nullptr); }  // fails only without memory
  ~State() { EVP_MD_CTX_free(context); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  EVP_MD_CTX* context;
};

Sha256::Sha256() : state_{std::make_unique<State>()} {
  const int ok = EVP_DigestInit_ex(state_->context, EVP_sha256(), nullptr);
  KITH_ASSERT(ok == 1);
}
Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;

void Sha256::update(std::string_view bytes) {
  const int ok = EVP_DigestUpdate(state_->context, bytes.data(), bytes.size());
  KITH_ASSERT(ok == 1);
}

std::string Sha256::digest() && {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  const int ok = EVP_DigestFinal_ex(state_->context, digest.data(), &length);
  KITH_ASSERT(ok == 1 && length == 32);
  return {digest.begin(), digest.begin() + length};
}

}  // namespace kith
