/* A program in C that uses each part of continuo.h once. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <continuo/c_interface/continuo.h>

static int spring(double t, const double *y, double *dydt, void *user) {
  const double stiffness = *(const double *)user;
  (void)t;
  dydt[0] = y[1];
  dydt[1] = -stiffness * y[0];
  return 0;
}

static int fall(void) {
  continuo_model *model = NULL;
  double state[2], *h;
  size_t rows;
  if (continuo_load_text("h'' = -10 [m/s^2]\nh(0) = 10 [m]; h'(0) = 0 [m/s]\nrun 0..2 [s]", "fall", &model) != CONTINUO_OK ||
      continuo_start(model) != CONTINUO_OK || continuo_advance(model, 1) != CONTINUO_OK ||
      continuo_get_state(model, state, 2) != CONTINUO_OK) {
    puts(continuo_error_message(model));
    continuo_free(model);
    return 1;
  }
  printf("%.9g %s, %.9g %s\n", state[0], continuo_unit(model, CONTINUO_STATES, 0), state[1],
         continuo_unit(model, CONTINUO_STATES, 1));
  if (continuo_run(model, CONTINUO_DEFAULT) != CONTINUO_OK) return 1;
  rows = continuo_count(model, CONTINUO_ROWS);
  h = (double *)malloc(rows * sizeof *h);
  printf("%d ", continuo_read_column(model, "h", h, rows));
  printf("%d\n", fabs(h[rows - 1] + 10) > 1e-9);
  free(h);
  continuo_free(model);
  return 0;
}

int main(void) {
  const double y0[] = {1, 0}, times[] = {0, 1};
  double stiffness = 1, rows[4];
  char message[100];
  if (fall() != 0) return 1;
  if (continuo_integrate(spring, &stiffness, 2, y0, times, 2, "dop853", 1e-10, 1e-12, rows, message, sizeof message)) {
    puts(message);
    return 1;
  }
  printf("%.6f %.6f\n%.6f %.6f\n", rows[0], -rows[1], rows[2], rows[3]);
  return 0;
}
