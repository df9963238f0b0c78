// SPDX-License-Identifier: GPL-3.0-or-later
// For the C++ files of this folder: what VTK compresses by zlib, in the same format, by libdeflate, in less than half
// the time.
#ifndef VSC_IO_VTK_DEFLATE_HH
#define VSC_IO_VTK_DEFLATE_HH

#include <new>

#include <libdeflate.h>

#include <vtkDataCompressor.h>
#include <vtkObjectFactory.h>

namespace vsc {

class deflate : public vtkDataCompressor {
public:
  static deflate *New() { VTK_STANDARD_NEW_BODY(deflate); }
  deflate(const deflate &) = delete;
  void operator=(const deflate &) = delete;

  size_t GetMaximumCompressionSpace(size_t size) override
  {
    return libdeflate_zlib_compress_bound(compressor_, size);
  }
  void SetCompressionLevel(int) override {}
  int GetCompressionLevel() override { return LEVEL; }

protected:
  deflate() : compressor_(libdeflate_alloc_compressor(LEVEL))
  {
    if (compressor_ == nullptr) throw std::bad_alloc();
  }
  ~deflate() override { libdeflate_free_compressor(compressor_); }

  // Files name the class whose format this is.
  const char *GetClassNameInternal() const override { return "vtkZLibDataCompressor"; }

  size_t CompressBuffer(const unsigned char *from, size_t size, unsigned char *to, size_t space) override
  {
    return libdeflate_zlib_compress(compressor_, from, size, to, space);
  }

  // Nothing is read by it.
  size_t UncompressBuffer(const unsigned char *, size_t, unsigned char *, size_t) override { return 0; }

private:
  // The quickest: a frame's numbers are hardly smaller at the higher ones, which take several times as long.
  static constexpr int LEVEL = 1;
  libdeflate_compressor *compressor_;
};

}  // namespace vsc

#endif
