//! Crews: every task is done once, in every frame, whatever becomes of one of them.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use crate::dispatch::crew::{Crew, Ending};
use crate::dispatch::queue::{Lfree, Local, Lock, Queue};

/// Sum of all tasks: each `n` adds `n - 1` twice, so `n` is `2^(n + 1) - 1` tasks.
fn total<Q: Queue<u32>>(queue: &Q, crew: Crew) -> u64 {
    let done = AtomicU64::new(0);
    let spent = crew.run(queue, [9, 5, 9, 1], |hands, task| {
        done.fetch_add(1, Ordering::Relaxed);
        if task > 0 {
            hands.add(task - 1);
            hands.add(task - 1);
        }
    });
    assert_eq!(spent.len(), crew.threads, "of each thread");
    let tasks: u64 = spent.iter().map(|spent| spent.tasks).sum();
    assert_eq!(tasks, done.load(Ordering::Relaxed), "tasks are counted");
    tasks
}

#[test]
fn every_task_is_done_once() {
    let expected = 2 * 1023 + 63 + 3;
    for threads in [1, 2, 7, 32] {
        for ending in Ending::ALL {
            for watched in [false, true] {
                let crew = Crew {
                    threads,
                    ending,
                    watched,
                };
                assert_eq!(total(&Lock::new(), crew), expected, "{crew:?}");
                assert_eq!(total(&Lfree::new(), crew), expected, "{crew:?}");
                assert_eq!(total(&Local::new(threads), crew), expected, "{crew:?}");
            }
        }
    }
}

#[test]
fn frames_follow_each_other() {
    let queue = Lfree::new();
    let sum = AtomicU64::new(0);
    let mut frame = 0_u64;
    let mut sums = Vec::new();
    Crew::new(4).frames(
        &queue,
        || {
            frame += 1;
            (frame <= 50).then_some(0..frame)
        },
        |_, task| {
            sum.fetch_add(task, Ordering::Relaxed);
        },
        || sums.push(sum.swap(0, Ordering::Relaxed)),
    );
    let expected: Vec<u64> = (1..=50).map(|n| n * (n - 1) / 2).collect();
    assert_eq!(sums, expected, "each frame has its own tasks");
}

/// Of one task that panics, with others waiting for it.
#[test]
fn a_task_that_panics_ends_the_crew() {
    for ending in Ending::ALL {
        let crew = Crew {
            threads: 3,
            ending,
            watched: false,
        };
        let run = AssertUnwindSafe(|| {
            crew.run(&Lock::new(), 0..100, |_, task| {
                assert!(task != 40, "task 40");
            })
        });
        let panic = catch_unwind(run).expect_err("the panic comes through");
        let words = panic.downcast_ref::<String>().map(String::as_str);
        let words = words.or(panic.downcast_ref::<&str>().copied());
        assert_eq!(words, Some("task 40"), "with its own words");
    }
}

/// Nor does what the application does between frames leave threads waiting.
#[test]
fn an_application_that_panics_ends_the_crew() {
    for (in_first, in_finish) in [(2, 9), (9, 2)] {
        let (mut begun, mut ended) = (0, 0);
        let run = AssertUnwindSafe(|| {
            Crew::new(3).frames(
                &Lfree::new(),
                || {
                    begun += 1;
                    assert!(begun != in_first, "the tasks of frame {begun}");
                    (begun < 5).then_some(0..10)
                },
                |_, _: u32| (),
                || {
                    ended += 1;
                    assert!(ended != in_finish, "the end of frame {ended}");
                },
            )
        });
        assert!(catch_unwind(run).is_err(), "the panic comes through");
    }
}

/// One long task and nothing else: whoever counts stays, and is idle.
#[test]
fn idle_time_is_that_of_waiting() {
    let crew = Crew {
        threads: 2,
        ending: Ending::Counted,
        watched: true,
    };
    let pause = Duration::from_millis(50);
    let spent = crew.run(&Lfree::new(), [()], |_, ()| std::thread::sleep(pause));
    let idle: Duration = spent.iter().map(|spent| spent.idle).sum();
    assert!(idle >= pause * 4 / 5, "one waits for the other: {idle:?}");
}
