// Tells the system around the lesson what has happened since it was told last, one message after the other.
import type { LessonFile } from '../document';
import type { LocalServer } from '../local_server';
import { findCmi5 } from './cmi5';
import { VisitIsOver, type Door, type Opening, type Progress } from './door';
import { tellDeclined, tellFrame } from './frame';
import { packed } from './packed';
import { findScorm } from './scorm';

/** What went wrong, as a key of a text. */
export type DoorTrouble = 'none' | 'refused' | 'closed' | 'too_long' | null;

/** The learning system, if there is one. */
export const findDoor = (): Opening | null => findCmi5() ?? findScorm();

/** Whether the author named pages that are told how it goes, and there is one around this page. */
export const isFramed = (file: LessonFile): boolean => file.origins.length > 0 && window.parent !== window;

export class Reporter {
  private isBusy = false;
  private hasNews = false;
  private trouble: DoorTrouble = null;
  private door: Door | null = null;
  private last: Promise<void> = Promise.resolve(); // what is being told

  constructor(
    private readonly file: LessonFile,
    private readonly onTrouble: (trouble: DoorTrouble) => void,
  ) {}

  /** From now on the learning system is told, too. */
  connect(door: Door): void {
    this.door = door;
    window.addEventListener('pagehide', () => door.leave());
    window.addEventListener('pageshow', ({ persisted }) => persisted && location.reload()); // it was left
  }

  async news(server: LocalServer): Promise<void> {
    this.hasNews = true;
    if (this.isBusy) return this.last;
    this.isBusy = true;
    await (this.last = this.tellAll(server));
  }

  private async tellAll(server: LocalServer): Promise<void> {
    while (this.hasNews) {
      this.hasNews = false;
      await this.tell(server);
    }
    this.isBusy = false;
  }

  /** The learner starts again or, with `for good`, leaves: the address of where to go then, or nothing. */
  async end(how: 'again' | 'for good'): Promise<string> {
    await this.last;
    try {
      if (how === 'for good') return (await this.door?.close()) ?? '';
      await this.door?.restart();
    } catch (error) {
      console.warn(String(error)); // the visit ends in any case
    }
    return '';
  }

  // Nothing before somebody has agreed, where there is something to agree to.
  private async tell(server: LocalServer): Promise<void> {
    const { stage } = server;
    if (stage === 'consent') return;
    if (stage === 'declined') return isFramed(this.file) ? tellDeclined(this.file.origins) : undefined;
    const isFinished = ['debrief', 'ended'].includes(stage);
    const progress: Progress = { ...(await server.progress()), isFinished };
    if (isFramed(this.file)) tellFrame(this.file.origins, progress, isFinished ? await server.export() : null);
    if (!this.door) return;
    try {
      const log = await packed(server.soFar);
      const fits = log.length <= this.door.room;
      await this.door.report(progress, fits ? log : null);
      this.say(fits ? null : 'too_long');
    } catch (error) {
      console.warn(String(error));
      this.say(error instanceof VisitIsOver ? 'closed' : 'refused'); // everything is told again with the next news
    }
  }

  private say(trouble: DoorTrouble): void {
    if (trouble !== this.trouble) this.onTrouble((this.trouble = trouble));
  }
}
