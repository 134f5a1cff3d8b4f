// Tells the system around the lesson what has happened since it was told last, one message after the other.
import type { LessonFile } from '../document';
import type { LocalServer } from '../local_server';
import { openCmi5 } from './cmi5';
import type { Door, Progress } from './door';
import { tellFrame } from './frame';
import { packed } from './packed';
import { openScorm } from './scorm';

/** What went wrong, as a key of a text. */
export type DoorTrouble = 'none' | 'refused' | 'too_long' | null;

/** The learning system, if there is one; otherwise why not. */
export async function findDoor(file: LessonFile): Promise<{ door: Door | null; trouble: DoorTrouble }> {
  try {
    const door = (await openCmi5()) ?? openScorm();
    return { door, trouble: !door && file.package ? 'none' : null };
  } catch (error) {
    console.warn(String(error));
    return { door: null, trouble: 'refused' };
  }
}

export class Reporter {
  private isBusy = false;
  private hasNews = false;
  private trouble: DoorTrouble = null;

  constructor(
    private readonly file: LessonFile,
    private readonly door: Door | null,
    private readonly onTrouble: (trouble: DoorTrouble) => void,
  ) {
    if (door) window.addEventListener('pagehide', () => door.leave());
  }

  async news(server: LocalServer): Promise<void> {
    const isFramed = this.file.origins.length > 0 && window.parent !== window;
    if (!this.door && !isFramed) return;
    this.hasNews = true;
    if (this.isBusy) return;
    this.isBusy = true;
    while (this.hasNews) {
      this.hasNews = false;
      await this.tell(server, isFramed);
    }
    this.isBusy = false;
  }

  private async tell(server: LocalServer, isFramed: boolean): Promise<void> {
    const isFinished = ['debrief', 'ended'].includes(server.stage);
    const progress: Progress = { ...(await server.progress()), isFinished };
    if (isFramed) tellFrame(this.file.origins, progress, isFinished ? await server.export() : null);
    if (!this.door) return;
    try {
      const log = await packed(server.soFar);
      const fits = log.length <= this.door.room;
      await this.door.report(progress, fits ? log : null);
      this.say(fits ? null : 'too_long');
    } catch (error) {
      console.warn(String(error));
      this.say('refused'); // everything is told again with the next news
    }
  }

  private say(trouble: DoorTrouble): void {
    if (trouble !== this.trouble) this.onTrouble((this.trouble = trouble));
  }
}
