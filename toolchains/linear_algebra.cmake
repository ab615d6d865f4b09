# Eigen under the float contract (docs/explanation/conventions.md, decision determinism): what needs matrices links jaywalk_linear_algebra.
find_package(Eigen3 3.3 REQUIRED NO_MODULE) # libeigen3-dev
add_library(jaywalk_linear_algebra INTERFACE)
target_link_libraries(jaywalk_linear_algebra INTERFACE Eigen3::Eigen)
target_compile_definitions(jaywalk_linear_algebra INTERFACE
  EIGEN_DONT_VECTORIZE # its vector code calls fused instructions where the processor has them
  EIGEN_NO_MALLOC # a matrix that would allocate is an assert
  EIGEN_INITIALIZE_MATRICES_BY_ZERO) # nothing depends on memory never written
