// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/frame_writer.h"

#include <pthread.h>
#include <time.h>

#include "base/mem.h"

struct vsc_frame_writer {
  vsc_pvd *pvd;
  bool beside;
  pthread_t thread;
  pthread_mutex_t lock;     // of all below
  pthread_cond_t change;    // of any of it
  vsc_snapshot *waiting;       // the next one
  bool writing, closed;
  double seconds;           // of processor time
  vsc_status status;        // of the first frame that failed, behind which none is written
  vsc_error error;
};

void vsc_snapshot_free(vsc_snapshot *frame)
{
  if (frame == NULL) return;
  for (size_t k = 0; k < frame->count; k++)
    if (frame->owned[k]) vsc_free((void *)frame->arrays[k].values);
  vsc_free(frame);
}

static double thread_seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static vsc_status write_frame(vsc_pvd *pvd, vsc_snapshot *frame, double *seconds, vsc_error *error)
{
  const double start = thread_seconds();
  vsc_status status = vsc_vtk_write_mesh(frame->file, &frame->shown, frame->count, frame->arrays,
                                         frame->double_precision, error);
  if (status == VSC_OK) status = vsc_pvd_add(pvd, frame->time, frame->name, error);
  vsc_snapshot_free(frame);
  *seconds = thread_seconds() - start;
  return status;
}

// Writes what waits until the writer is closed.
static void *serve(void *context)
{
  vsc_frame_writer *writer = context;
  pthread_mutex_lock(&writer->lock);
  for (;;) {
    while (writer->waiting == NULL && !writer->closed) pthread_cond_wait(&writer->change, &writer->lock);
    vsc_snapshot *frame = writer->waiting;
    if (frame == NULL) break;
    writer->waiting = NULL;
    writer->writing = true;
    pthread_cond_broadcast(&writer->change);
    pthread_mutex_unlock(&writer->lock);
    vsc_error error;
    double seconds;
    const vsc_status status = write_frame(writer->pvd, frame, &seconds, &error);
    pthread_mutex_lock(&writer->lock);
    writer->writing = false;
    writer->seconds += seconds;
    if (status != VSC_OK) {
      writer->status = status;
      writer->error = error;
      vsc_snapshot_free(writer->waiting);
      writer->waiting = NULL;
    }
    pthread_cond_broadcast(&writer->change);
  }
  pthread_mutex_unlock(&writer->lock);
  return NULL;
}

vsc_status vsc_frame_writer_create(vsc_pvd *pvd, bool beside, vsc_frame_writer **writer, vsc_error *error)
{
  vsc_frame_writer *made;
  *writer = NULL;
  if (!VSC_NEW(made, 1)) return vsc_fail_memory(error, "the frames' writer");
  made->pvd = pvd;
  made->beside = beside;
  pthread_mutex_init(&made->lock, NULL);
  pthread_cond_init(&made->change, NULL);
  if (beside && pthread_create(&made->thread, NULL, serve, made) != 0) {
    made->beside = false;
    vsc_frame_writer_free(made);
    return vsc_fail(error, VSC_SYSTEM, "no thread can be started for the frames: take --threads 1");
  }
  *writer = made;
  return VSC_OK;
}

// With the lock held.
static vsc_status tell(const vsc_frame_writer *writer, vsc_error *error)
{
  if (writer->status != VSC_OK && error != NULL) *error = writer->error;
  return writer->status;
}

vsc_status vsc_frame_writer_take(vsc_frame_writer *writer, vsc_snapshot *frame, vsc_error *error)
{
  pthread_mutex_lock(&writer->lock);
  while (writer->waiting != NULL && writer->status == VSC_OK) pthread_cond_wait(&writer->change, &writer->lock);
  if (writer->status != VSC_OK) {
    vsc_snapshot_free(frame);
  } else if (writer->beside) {
    writer->waiting = frame;
    pthread_cond_broadcast(&writer->change);
  } else {
    double seconds;
    writer->status = write_frame(writer->pvd, frame, &seconds, &writer->error);
    writer->seconds += seconds;
  }
  const vsc_status status = tell(writer, error);
  pthread_mutex_unlock(&writer->lock);
  return status;
}

vsc_status vsc_frame_writer_finish(vsc_frame_writer *writer, vsc_error *error)
{
  pthread_mutex_lock(&writer->lock);
  while (writer->waiting != NULL || writer->writing) pthread_cond_wait(&writer->change, &writer->lock);
  if (writer->status == VSC_OK) writer->status = vsc_pvd_finish(writer->pvd, &writer->error);
  const vsc_status status = tell(writer, error);
  pthread_mutex_unlock(&writer->lock);
  return status;
}

double vsc_frame_writer_seconds(vsc_frame_writer *writer)
{
  pthread_mutex_lock(&writer->lock);
  const double seconds = writer->seconds;
  pthread_mutex_unlock(&writer->lock);
  return seconds;
}

void vsc_frame_writer_free(vsc_frame_writer *writer)
{
  if (writer == NULL) return;
  pthread_mutex_lock(&writer->lock);
  writer->closed = true;
  pthread_cond_broadcast(&writer->change);
  pthread_mutex_unlock(&writer->lock);
  if (writer->beside) pthread_join(writer->thread, NULL);
  vsc_pvd_finish(writer->pvd, NULL);
  pthread_cond_destroy(&writer->change);
  pthread_mutex_destroy(&writer->lock);
  vsc_free(writer);
}
