#include "io/container/formats.hpp"

#ifdef SLIPFIT_HAS_ZIP
#include <zlib.h>

#include <array>
#include <utility>
#endif

namespace slipfit::reading {

#ifdef SLIPFIT_HAS_ZIP
namespace {

class GzipStream final : public ByteStream {
 public:
  GzipStream(std::unique_ptr<ByteStream> packed, std::string name)
      : packed_(std::move(packed)), name_(name), limit_(std::move(name)) {
    constexpr int kGzipWindow = 15 + 16;
    if (inflateInit2(&state_, kGzipWindow) != Z_OK) throw std::bad_alloc();
  }
  ~GzipStream() override { inflateEnd(&state_); }
  GzipStream(const GzipStream&) = delete;
  GzipStream& operator=(const GzipStream&) = delete;

  std::size_t read(char* buffer, std::size_t size) override {
    state_.next_out =
        reinterpret_cast<Bytef*>(buffer);  // NOLINT(cppcoreguidelines-pro-type-reinterpret-cast): zlib's bytes
    state_.avail_out = static_cast<uInt>(size);
    while (state_.avail_out > 0 && !ended_) {
      if (state_.avail_in == 0 && !fill()) throw damaged(name_, "the gzip file ends too soon");
      const int status = inflate(&state_, Z_NO_FLUSH);
      if (status == Z_STREAM_END) {
        next_member();
      } else if (status != Z_OK && status != Z_BUF_ERROR) {
        throw damaged(name_, "the gzip file is damaged");
      }
    }
    const std::size_t count = size - state_.avail_out;
    limit_.add_unpacked(count);
    return count;
  }

 private:
  bool fill() {
    state_.next_in =
        reinterpret_cast<Bytef*>(input_.data());  // NOLINT(cppcoreguidelines-pro-type-reinterpret-cast): as above
    state_.avail_in = static_cast<uInt>(packed_->read(input_.data(), input_.size()));
    limit_.add_packed(state_.avail_in);
    return state_.avail_in > 0;
  }

  /// Members may follow each other; what follows and is none is read for the digest and left alone.
  void next_member() {
    constexpr Bytef kMagic = 0x1F;
    if ((state_.avail_in > 0 || fill()) && *state_.next_in == kMagic) {
      inflateReset(&state_);
      return;
    }
    while (fill()) {
    }
    ended_ = true;
  }

  std::unique_ptr<ByteStream> packed_;
  std::string name_;
  z_stream state_{};
  std::array<char, 65536> input_{};
  UnpackingLimit limit_;
  bool ended_ = false;
};

}  // namespace

Container open_gzip(TextStream packed, const std::string& name) {
  packed.bytes = std::make_unique<GzipStream>(std::move(packed.bytes), name);
  packed.size = 0;
  packed.assumed.emplace_back("The file is compressed (gzip).");
  return one_table(std::move(packed));
}

#else

Container open_gzip(TextStream /*packed*/, const std::string& name) {
  throw not_built_in(name, "compressed with gzip", "zlib1g-dev and libminizip-dev");
}

#endif

}  // namespace slipfit::reading
