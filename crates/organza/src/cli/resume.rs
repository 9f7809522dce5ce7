//! `organza resume`.

use organza::picture::{poster_path, write_poster};
use organza::record::{Resumed, resume};

use super::args::Resume;
use super::simulate::finish;
use super::{Failure, output, with_threads};

pub(crate) fn run(args: &Resume) -> Result<(), Failure> {
    let path = &args.recording;
    with_threads(args.threads.threads, || match resume(path, args.frames)? {
        Resumed::Complete { last_frame } => {
            let path = path.display();
            let more = "--frames N goes on beyond it";
            output::print(&format!("{path}: complete to frame {last_frame} already; {more}\n"))
        }
        Resumed::Closed { last_frame } => {
            write_poster(path, &poster_path(path))?;
            let path = path.display();
            output::print(&format!("{path}: had all frames to {last_frame}, and is complete now\n"))
        }
        Resumed::Continues { from, found, run } => {
            run.warnings().iter().for_each(|warning| output::warning(warning));
            if !args.quiet {
                let path = path.display();
                output::note(&format!(
                    "{path}: {found} complete frames found, going on after frame {from}"
                ));
            }
            finish(*run, args.quiet)
        }
    })
}
