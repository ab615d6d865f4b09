#include "drivers/ros/shared_ring.h"

#include <fcntl.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>

#include "drivers/wire/file_descriptor.h"
#include "hal/types/errors.h"

namespace jaywalk::ros {
namespace {

constexpr std::uint64_t kMagic = 0x31676E6972776A0AU;  // "\njwring1"
constexpr std::size_t kWord = sizeof(std::uint64_t);

std::uint64_t load(std::uint64_t& word, std::memory_order order = std::memory_order_relaxed) noexcept {
  return std::atomic_ref(word).load(order);
}

/// A file of this user's alone, under one name.
std::optional<struct stat> own_file(int file) noexcept {
  struct stat is {};
  const bool is_own = ::fstat(file, &is) == 0 && S_ISREG(is.st_mode) && is.st_uid == ::geteuid() && is.st_nlink == 1 &&
                      (is.st_mode & (S_IRWXG | S_IRWXO)) == 0;
  return is_own ? std::optional(is) : std::nullopt;
}

}  // namespace

struct SharedRing::Header {
  std::uint64_t magic, message_bytes, slots;
  alignas(64) std::atomic<std::uint64_t> written;
  std::atomic<std::uint64_t> alarms;
  std::atomic<std::uint32_t> bell;  ///< a futex
};

std::size_t SharedRing::bytes_of(const Shape& shape) noexcept {
  return sizeof(Header) + shape.slots * (kWord + shape.message_bytes);
}

std::unique_ptr<SharedRing> SharedRing::map(const std::filesystem::path& path, int file, const Shape& shape,
                                            bool is_maker) {
  const auto is = own_file(file);
  if (!is || is->st_size != static_cast<off_t>(bytes_of(shape))) return nullptr;
  std::unique_ptr<SharedRing> ring(new SharedRing(path, *is, shape, is_maker));
  void* const memory = ::mmap(nullptr, bytes_of(shape), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, file, 0);
  if (memory == MAP_FAILED) return nullptr;
  ring->header_ = static_cast<Header*>(memory);
  return ring;
}

std::unique_ptr<SharedRing> SharedRing::make(const std::filesystem::path& path, const Shape& shape) {
  const auto refuse = [&](const std::string& cause) {
    throw StartupError(path.string() + ": " + cause, "take away what lies there, and see to its folder's rights");
  };
  if (const wire::FileDescriptor old(::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
      old.get() >= 0 || errno != ENOENT) {
    std::uint64_t magic = 0;
    const bool is_ring = old.get() >= 0 && own_file(old.get()) &&
                         ::pread(old.get(), &magic, sizeof magic, 0) == sizeof magic && magic == kMagic;
    if (!is_ring) refuse("is there, and is no file of jaywalk's");
    ::unlink(path.c_str());
  }
  const wire::FileDescriptor file(
      ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR));
  if (file.get() < 0) refuse(std::string("cannot be made: ") + std::strerror(errno));
  if (const int failure = ::posix_fallocate(file.get(), 0, static_cast<off_t>(bytes_of(shape))); failure != 0)
    refuse(std::string("has no room: ") + std::strerror(failure));
  auto ring = map(path, file.get(), shape, true);
  if (!ring) refuse(std::string("cannot be mapped: ") + std::strerror(errno));
  ring->header_->message_bytes = shape.message_bytes;
  ring->header_->slots = shape.slots;
  std::atomic_ref(ring->header_->magic).store(kMagic, std::memory_order_release);
  return ring;
}

std::unique_ptr<SharedRing> SharedRing::find(const std::filesystem::path& path, const Shape& shape) {
  const wire::FileDescriptor file(::open(path.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  auto ring = map(path, file.get(), shape, false);
  const bool is_sound = ring && load(ring->header_->magic, std::memory_order_acquire) == kMagic &&
                        load(ring->header_->message_bytes) == shape.message_bytes &&
                        load(ring->header_->slots) == shape.slots;
  if (!is_sound) return nullptr;
  ring->written_ = ring->header_->written.load();
  ring->next_ = ring->written_ + 1;
  return ring;
}

SharedRing::~SharedRing() {
  if (header_ != nullptr) ::munmap(header_, bytes_of(shape_));
  if (is_maker_ && is_current()) ::unlink(path_.c_str());
}

std::uint64_t* SharedRing::slot_of(std::uint64_t number) const noexcept {
  auto* const slots = reinterpret_cast<std::byte*>(header_) + sizeof(Header);
  return reinterpret_cast<std::uint64_t*>(slots + number % shape_.slots * (kWord + shape_.message_bytes));
}

bool SharedRing::is_current() const noexcept {
  struct stat there {};
  return ::lstat(path_.c_str(), &there) == 0 && there.st_ino == is_.st_ino && there.st_dev == is_.st_dev;
}

void SharedRing::write(std::span<const std::byte> message) noexcept {
  std::uint64_t* const slot = slot_of(++written_);
  std::atomic_ref(slot[0]).store(0, std::memory_order_relaxed);  // no word below is seen before this
  for (std::size_t k = 0; k < shape_.message_bytes / kWord; ++k) {
    std::uint64_t word = 0;
    std::memcpy(&word, message.data() + k * kWord, kWord);
    std::atomic_ref(slot[1 + k]).store(word, std::memory_order_release);
  }
  std::atomic_ref(slot[0]).store(written_, std::memory_order_release);
  header_->written.store(written_, std::memory_order_release);
  ring_bell();
}

SharedRing::Took SharedRing::read(std::span<std::byte> message) noexcept {
  const std::uint64_t newest = header_->written.load(std::memory_order_acquire);
  if (newest == next_ - 1) return Took::kNothing;
  if (const std::uint64_t behind = newest - next_; behind >= shape_.slots) {  // overwritten, or set back
    lost_ += newest > next_ ? behind : 0;
    next_ = newest;
  }
  std::uint64_t* const slot = slot_of(next_);
  const bool was_whole = load(slot[0], std::memory_order_acquire) == next_;
  for (std::size_t k = 0; k < shape_.message_bytes / kWord; ++k) {
    const std::uint64_t word = load(slot[1 + k], std::memory_order_acquire);
    std::memcpy(message.data() + k * kWord, &word, kWord);
  }
  const bool is_whole = was_whole && load(slot[0]) == next_;
  ++next_;
  return is_whole ? Took::kMessage : Took::kTorn;
}

void SharedRing::skip() noexcept { next_ = header_->written.load(std::memory_order_acquire) + 1; }

void SharedRing::wait(Duration most) const noexcept {
  const std::uint32_t heard = header_->bell.load(std::memory_order_acquire);
  if (header_->written.load(std::memory_order_acquire) != next_ - 1) return;
  const timespec span{.tv_sec = most / std::chrono::seconds(1), .tv_nsec = (most % std::chrono::seconds(1)).count()};
  ::syscall(SYS_futex, &header_->bell, FUTEX_WAIT, heard, &span, nullptr, 0);
}

void SharedRing::ring_bell() noexcept {
  header_->bell.fetch_add(1, std::memory_order_release);
  ::syscall(SYS_futex, &header_->bell, FUTEX_WAKE, INT32_MAX, nullptr, nullptr, 0);
}

void SharedRing::raise_alarm() noexcept {
  header_->alarms.fetch_add(1, std::memory_order_release);
  ring_bell();
}

std::uint64_t SharedRing::alarms() const noexcept { return header_->alarms.load(std::memory_order_acquire); }

}  // namespace jaywalk::ros
