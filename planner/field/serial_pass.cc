// All stages on the processor, compiled once.
#include "planner/field/executor.h"
#include "planner/field/pass.h"

namespace jaywalk::field {

template class Pass<SerialExecutor>;

}  // namespace jaywalk::field
