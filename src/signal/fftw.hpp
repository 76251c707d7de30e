#pragma once

#include <fftw3.h>
#include <pthread.h>

#include <complex>
#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>

namespace slipfit::signal {

/// The locks of the planner. A process that forks while another thread holds one of them, as a batch next to other
/// threads does, would leave it locked in its child: a fork takes both first.
struct PlanLocks {
  std::mutex kept;  ///< the plans that are kept; taken before `planner`
  std::mutex planner;

  static PlanLocks& get() {
    static PlanLocks locks;
    return locks;
  }

 private:
  PlanLocks() {
#ifndef __EMSCRIPTEN__  // no processes
    const auto take = [] {
      get().kept.lock();
      get().planner.lock();
    };
    const auto release = [] {
      get().planner.unlock();
      get().kept.unlock();
    };
    pthread_atfork(take, release, release);
#endif
  }
};

/// Complex FFTW transform of one length, planned once. The planner is not thread safe, so one lock protects it;
/// the arrays belong to the caller, so that any number of transforms, in any thread, share a plan.
class ComplexTransform {
 public:
  using Complex = std::complex<double>;
  struct Release {
    void operator()(Complex* memory) const { ::operator delete(memory, kAlignment); }
  };
  using Buffer = std::unique_ptr<Complex[], Release>;

  /// Returns uninitialised memory, aligned as FFTW requires. (fftw_malloc ends the program without memory; this
  /// function throws.)
  static Buffer allocate(std::size_t length) {
    return Buffer(static_cast<Complex*>(::operator new(sizeof(Complex) * length, kAlignment)));
  }

  explicit ComplexTransform(std::size_t length) : length_(length) {
    const Buffer in = allocate(length);
    const Buffer out = is_in_place() ? Buffer() : allocate(length);
    (void)allocate(length / 2 + kReserve);
    const std::lock_guard lock(PlanLocks::get().planner);
    plan_ = fftw_plan_dft_1d(static_cast<int>(length), raw(in), raw(out ? out : in), FFTW_FORWARD, FFTW_ESTIMATE);
  }
  ~ComplexTransform() {
    const std::lock_guard lock(PlanLocks::get().planner);
    fftw_destroy_plan(plan_);
  }
  ComplexTransform(const ComplexTransform&) = delete;
  ComplexTransform& operator=(const ComplexTransform&) = delete;
  ComplexTransform(ComplexTransform&&) = delete;
  ComplexTransform& operator=(ComplexTransform&&) = delete;

  [[nodiscard]] std::size_t length() const { return length_; }
  /// The transformed values; those handed in are overwritten.
  [[nodiscard]] Buffer run(Buffer in) const {
    Buffer out = is_in_place() ? Buffer() : allocate(length_);
    (void)allocate(kReserve);
    fftw_execute_dft(plan_, raw(in), raw(out ? out : in));
    return out ? std::move(out) : std::move(in);
  }

 private:
  /// Half the memory, and no slower at millions of points, where memory decides. At 100 000 it plans five times as
  /// long.
  [[nodiscard]] bool is_in_place() const { return length_ > kLargeLength; }

  static constexpr std::align_val_t kAlignment{64};
  /// Allocated and freed at once before FFTW plans or runs: its own allocations, whose failure ends the program, then
  /// succeed. 1 MB: the planner's tables of all kernels for this processor, and the buffers of a plan.
  static constexpr std::size_t kReserve = std::size_t{1} << 16U;
  static constexpr std::size_t kLargeLength = std::size_t{1} << 20U;

  static fftw_complex* raw(const Buffer& buffer) {
    return static_cast<fftw_complex*>(static_cast<void*>(buffer.get()));
  }

  std::size_t length_;
  fftw_plan plan_ = nullptr;
};

}  // namespace slipfit::signal
