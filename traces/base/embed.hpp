#pragma once

#include <cstddef>
#include <vector>

/// Embeds a file in the program unchanged, as the bytes between `SYMBOL_begin` and `SYMBOL_end`. `path` is a string
/// literal with an absolute path; CMake must list the file in OBJECT_DEPENDS. For file scope.
#define VESTIGE_EMBED(symbol, path)                                              \
  asm(".pushsection .rodata\n" #symbol "_begin:\n.incbin \"" path "\"\n" #symbol \
      "_end:\n"                                                                  \
      ".popsection\n");                                                          \
  extern "C" const std::byte symbol##_begin[];                                   \
  extern "C" const std::byte symbol##_end[]

/// The bytes of an embedded file.
#define VESTIGE_EMBEDDED(symbol) std::vector<std::byte>(symbol##_begin, symbol##_end)
