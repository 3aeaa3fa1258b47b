#include "shot/version.h"

namespace ebru {

const char* programVersion() { return EBRU_VERSION; }

}  // namespace ebru
