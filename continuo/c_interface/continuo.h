/* Continuo for C, and for all that can call C: Julia, MATLAB, Octave, Python's ctypes.
 *
 *   continuo_model *model = NULL;
 *   if (continuo_load("ball.sim", &model) != CONTINUO_OK || continuo_run(model, CONTINUO_DEFAULT) != CONTINUO_OK)
 *     puts(continuo_error_message(model));
 *   size_t rows = continuo_count(model, CONTINUO_ROWS);
 *   double *h = malloc(rows * sizeof *h);
 *   continuo_read_column(model, "h", h, rows);
 *   continuo_free(model);
 *
 * Errors are values. A function that can fail returns one of the codes below, and the model keeps what went wrong until
 * its next call that can fail. Texts belong to the model, and stay as they are until its next call that is not a
 * question; no text is ever NULL. No call prints, ends the program or changes anything outside of its model.
 *
 * A model serves one thread at a time, but for continuo_interrupt, which may come from any. Different models may be
 * used by different threads at once. Where a function is given NULL in place of a model it returns CONTINUO_MISUSE, or
 * zero, or a text that says so.
 */
#ifndef CONTINUO_H
#define CONTINUO_H

#include <stddef.h>

#if defined(__GNUC__)
#define CONTINUO_API __attribute__((visibility("default")))
#else
#define CONTINUO_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct continuo_model continuo_model;

/* What functions return. */
enum {
  CONTINUO_OK = 0,
  CONTINUO_ENDED = 1,  /* continuo_advance: an event has ended the motion before the time asked for */
  CONTINUO_ERROR = 2,  /* the model, or what is asked of it, is wrong: continuo_error_message */
  CONTINUO_FAILED = 3, /* the integration did not reach its end; what it computed can be read */
  CONTINUO_MISUSE = 4, /* the call itself is wrong: a NULL, a buffer of another size, no such name */
  CONTINUO_MEMORY = 5  /* there is no memory left */
};

/* What continuo_count counts, and continuo_name and continuo_unit name. */
enum {
  CONTINUO_STATES = 0,
  CONTINUO_PARAMETERS = 1,
  CONTINUO_COLUMNS = 2, /* of a run: t, the states, the outputs, the energies */
  CONTINUO_ROWS = 3,    /* of a run; they have no names */
  CONTINUO_EVENTS = 4   /* that have occurred, in the run or in the motion that was last begun */
};

/* In place of a number: what the model says. */
#define CONTINUO_DEFAULT (-1.7976931348623157e308)

/* "0.1.0" */
CONTINUO_API const char *continuo_version(void);

/* ---- models ---- */

/* Reads a model. *model is a handle also where the model is wrong, to ask for the error; it is NULL only where there is
 * no memory. To be freed in any case. Files that the model reads are found beside it. */
CONTINUO_API int continuo_load(const char *path, continuo_model **model);
/* The same for a text in memory; messages call it `name` (NULL: "model"). */
CONTINUO_API int continuo_load_text(const char *text, const char *name, continuo_model **model);
/* Frees the model with all that was read from it. NULL is nothing to free. */
CONTINUO_API void continuo_free(continuo_model *model);

/* ---- what went wrong last ---- */

/* The message as the command `continuo` shows it, of several lines; empty where the last call succeeded. */
CONTINUO_API const char *continuo_error_message(const continuo_model *model);
/* "E240": `continuo explain E240` has the whole story. Empty where there is no code. */
CONTINUO_API const char *continuo_error_code(const continuo_model *model);
/* What to do about it; may be empty. */
CONTINUO_API const char *continuo_error_hint(const continuo_model *model);
/* Where in the text, counted from 1; 0 where the error has no place. */
CONTINUO_API int continuo_error_line(const continuo_model *model);
CONTINUO_API int continuo_error_column(const continuo_model *model);

/* ---- names ---- */

CONTINUO_API size_t continuo_count(const continuo_model *model, int what);
/* Number i of them, counted from 0; empty where there is none. */
CONTINUO_API const char *continuo_name(const continuo_model *model, int what, size_t i);
/* Empty where it has no unit. */
CONTINUO_API const char *continuo_unit(const continuo_model *model, int what, size_t i);

/* ---- parameters and options ---- */

/* In the unit of the parameter. Later runs have it, and a motion that is under way from where it stands. */
CONTINUO_API int continuo_set_parameter(continuo_model *model, const char *name, double value);
CONTINUO_API int continuo_get_parameter(continuo_model *model, const char *name, double *value);
/* The initial value of a state in later runs, in its unit. */
CONTINUO_API int continuo_set_initial(continuo_model *model, const char *state, double value);
/* The method of later runs, by its name; NULL: what the model says. */
CONTINUO_API int continuo_set_method(continuo_model *model, const char *name);
/* Of later runs: "rtol", "atol", "step" (a fixed one, in place of a tolerance), "max_step", "max_steps", "from",
 * "output" (the time between rows; 0: a row at every step). CONTINUO_DEFAULT: what the model says. */
CONTINUO_API int continuo_set_option(continuo_model *model, const char *option, double value);

/* ---- a whole run ---- */

/* Runs to the time `to` (CONTINUO_DEFAULT: to that of the model). */
CONTINUO_API int continuo_run(continuo_model *model, double to);
/* Copies a column into a buffer of `count` numbers, which must be as many as there are rows. */
CONTINUO_API int continuo_read_column(continuo_model *model, const char *name, double *buffer, size_t count);
/* Copies all rows one after the other: `count` is rows times columns. */
CONTINUO_API int continuo_read_rows(continuo_model *model, double *buffer, size_t count);
/* How it ended, in a sentence. */
CONTINUO_API const char *continuo_outcome(const continuo_model *model);
/* Ends a run, or a step of a motion, as soon as possible: from any thread. */
CONTINUO_API void continuo_interrupt(continuo_model *model);

/* ---- a motion, step by step ---- */

/* Begins at the start of the model. The rows of the last run are forgotten. */
CONTINUO_API int continuo_start(continuo_model *model);
/* Moves on to the time t, also beyond the end of the model's run, never back. CONTINUO_ENDED where an event has ended
 * the motion before. */
CONTINUO_API int continuo_advance(continuo_model *model, double t);
/* Where the motion stands; NaN where none was begun. */
CONTINUO_API double continuo_time(const continuo_model *model);
/* The state there: `count` numbers, as many as there are states. */
CONTINUO_API int continuo_get_state(continuo_model *model, double *buffer, size_t count);
/* Puts another state in its place. */
CONTINUO_API int continuo_set_state(continuo_model *model, const double *buffer, size_t count);

/* ---- events ---- */

/* Number i of the events that have occurred: its time, and its name or mark. */
CONTINUO_API int continuo_event(const continuo_model *model, size_t i, double *t, const char **name);

/* ---- functions of other languages ---- */

/* Writes dy/dt to dydt. Anything but 0 ends the integration. */
typedef int (*continuo_function)(double t, const double *y, double *dydt, void *user);

/* Integrates n equations dy/dt = f(t, y) from times[0], where y = y0, to times[count-1], and writes y at each of the
 * `count` times to rows of n numbers. Times ascend or descend strictly. `method`: a name, or NULL to have one chosen.
 * rtol, atol: CONTINUO_DEFAULT for 1e-6 and 1e-9. `message`, of `size` characters, gets how the run ended, or why it
 * could not begin; it may be NULL. After CONTINUO_FAILED the rows that were not reached are NaN. */
CONTINUO_API int continuo_integrate(continuo_function f, void *user, size_t n, const double *y0, const double *times,
                                    size_t count, const char *method, double rtol, double atol, double *rows,
                                    char *message, size_t size);

#ifdef __cplusplus
}
#endif
#endif
