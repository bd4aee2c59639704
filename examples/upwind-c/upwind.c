/* Upwind differences for u_t + u_x = 0 on [0, period), u = sin(x) at t = 0. Of the case it needs three numbers. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double number(const char *text, const char *name) {
  const char *at = strstr(text, name);
  if (at == NULL) {
    fprintf(stderr, "the case has no %s\n", name);
    exit(1);
  }
  return atof(at + strlen(name));
}

int main(void) {
  char text[4096]; /* numbers stand before the lists of particles */
  text[fread(text, 1, sizeof text - 1, stdin)] = '\0';
  const double period = number(text, "\"period\":"), T = number(text, "\"T\":");
  const int N = (int)number(text, "\"N\":");
  const double h = period / N;
  const int steps = (int)ceil(2.0 * T / h);
  double *u = malloc(N * sizeof *u);
  for (int j = 0; j < N; ++j) u[j] = sin(j * h);
  for (int n = 0; n < steps; ++n) {
    double left = u[N - 1];
    for (int j = 0; j < N; ++j) {
      const double here = u[j];
      u[j] -= T / steps * (here - left) / h;
      left = here;
    }
  }
  printf("{\"x\": [");
  for (int j = 0; j < N; ++j) printf("%s%.17g", j > 0 ? ", " : "", j * h);
  printf("], \"u\": [");
  for (int j = 0; j < N; ++j) printf("%s%.17g", j > 0 ? ", " : "", u[j]);
  printf("]}\n");
  free(u);
  return 0;
}
