// The version of continuo.h.
#include <continuo/c_interface/continuo.h>

extern "C" const char* continuo_version(void) {
  return CONTINUO_VERSION;
}
