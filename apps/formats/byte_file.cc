#include "apps/formats/byte_file.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "hal/text_file.h"
#include "hal/types/errors.h"

namespace jaywalk::exchange {
namespace {

bool unpack_lz4(std::string_view packed, std::string& out) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0U) return false;
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> owned(context,
                                                                                   &LZ4F_freeDecompressionContext);
  std::size_t taken = 0, given = 0, left = 1;  // left: 0 when the frame is whole
  while (taken < packed.size() && left != 0) {
    std::size_t from = packed.size() - taken, to = out.size() - given;
    left = LZ4F_decompress(context, out.data() + given, &to, packed.data() + taken, &from, nullptr);
    if (LZ4F_isError(left) != 0U || (from == 0 && to == 0)) return false;
    taken += from, given += to;
  }
  return left == 0 && given == out.size();
}

bool unpack_bz2(std::string_view packed, std::string& out) {
  auto bytes = static_cast<unsigned>(out.size());
  std::string source(packed);  // its interface wants what it could write to
  const int code =
      BZ2_bzBuffToBuffDecompress(out.data(), &bytes, source.data(), static_cast<unsigned>(source.size()), 0, 0);
  return code == BZ_OK && bytes == out.size();
}

}  // namespace

ByteFile::ByteFile(const std::filesystem::path& file, std::string remedy)
    : file_(file), remedy_(std::move(remedy)), in_(file, std::ios::binary) {
  require_readable(file, name() + ": ", "give a recording");
  size_ = std::filesystem::file_size(file);
}

std::string ByteFile::read(std::uint64_t at, std::uint64_t bytes) {
  if (bytes > kMostRecordBytes) refuse(at, "a record of " + std::to_string(bytes) + " bytes");
  if (at > size_ || bytes > size_ - at) refuse(at, "the file ends before what begins here");
  std::string out(bytes, '\0');
  in_.seekg(static_cast<std::streamoff>(at));
  in_.read(out.data(), static_cast<std::streamsize>(bytes));
  if (!in_) refuse(at, "cannot be read");
  return out;
}

void ByteFile::refuse(std::uint64_t at, const std::string& cause) const {
  throw StartupError(name() + ": byte " + std::to_string(at) + ": " + cause, remedy_);
}

bool can_unpack(std::string_view method) {
  constexpr std::array<std::string_view, 5> kMethods{"", "none", "zstd", "lz4", "bz2"};
  return std::find(kMethods.begin(), kMethods.end(), method) != kMethods.end();
}

std::optional<std::string> unpack(std::string_view method, std::string_view packed, std::size_t bytes) {
  if (method.empty() || method == "none")
    return packed.size() == bytes ? std::optional<std::string>(packed) : std::nullopt;
  std::string out(bytes, '\0');
  const bool whole = method == "zstd"  ? ZSTD_decompress(out.data(), bytes, packed.data(), packed.size()) == bytes
                     : method == "lz4" ? unpack_lz4(packed, out)
                     : method == "bz2" ? unpack_bz2(packed, out)
                                       : false;
  return whole ? std::optional(std::move(out)) : std::nullopt;
}

std::optional<std::string> unpack_zstd(std::string_view packed, std::size_t most) {
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(), &ZSTD_freeDStream);
  std::string out;
  std::string block(ZSTD_DStreamOutSize(), '\0');
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  std::size_t left = 1;  // 0 when a frame is whole
  while (in.pos < in.size || left != 0) {
    ZSTD_outBuffer to{block.data(), block.size(), 0};
    const std::size_t before = in.pos;
    left = ZSTD_decompressStream(stream.get(), &to, &in);
    if (ZSTD_isError(left) != 0U || (to.pos == 0 && in.pos == before)) return std::nullopt;
    if (out.size() + to.pos > most) return std::nullopt;
    out.append(block.data(), to.pos);
  }
  return out;
}

std::string packed_zstd(std::string_view bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  out.resize(
      ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));  // with that much room it cannot fail
  return out;
}

}  // namespace jaywalk::exchange
