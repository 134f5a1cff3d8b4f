// The lesson that is being taught: its boards, animated, why it was chosen, and what came next.
import type { JSX } from 'preact';
import { useLayoutEffect, useMemo, useState } from 'preact/hooks';
import { Player } from './steps_player';
import { BoardView as BoardDrawing } from '../../shared/board/board';
import { Patterns } from '../../shared/board/glyphs';
import { closedAt, played } from '../../shared/board/repeats';
import { Legend } from '../../shared/board/legend';
import { worldText, type MapDomain, type PlayBoard } from '../../shared/board/types';
import { boardText, playedText } from '../../shared/play/words';
import { useCalm, usePlayback } from '../../shared/playback';
import type { LessonNow, RunnerUp, ShownBoard } from '../protocol';
import { Explained } from '../tip';
import { capitalised } from '../../shared/texts';

function useDrawing(board: PlayBoard): { domain: MapDomain; legend: Legend } {
  const key = JSON.stringify(board.domain);
  return useMemo(() => ({ domain: board.domain, legend: new Legend(board.domain) }), [key]);
}

interface Choice {
  id: string;
  label: string;
  shown: ShownBoard;
  isTest: boolean;
}

function choicesOf(lesson: LessonNow): Choice[] {
  return [
    ...lesson.demonstrations.map((shown, i) => ({ id: `d${i}`, label: `Demo ${i + 1}`, shown, isTest: false })),
    ...lesson.tests.map((shown, i) => ({ id: `t${i}`, label: `Test ${i + 1}`, shown, isTest: true })),
  ];
}

// `isDeep`: for researchers.
export function LessonPanel({ lesson, period, isDeep }: { lesson: LessonNow | undefined; period: number; isDeep: boolean }): JSX.Element {
  const [picked, setPicked] = useState('d0');
  if (!lesson) {
    return (
      <section class="lesson-now" aria-labelledby="lesson-title">
        <h3 id="lesson-title">Lesson</h3>
        <p class="hint">No lesson is being shown.</p>
      </section>
    );
  }
  const choices = choicesOf(lesson);
  const choice = choices.find(({ id }) => id === picked) ?? choices[0];
  return (
    <section class="lesson-now" aria-labelledby="lesson-title">
      <div class="lesson-head">
        <h3 id="lesson-title">Lesson, period {period}</h3>
        <div class="picks" role="group" aria-label="Board">
          {choices.map(({ id, label }) => (
            <button type="button" class="small" aria-pressed={id === choice?.id} onClick={() => setPicked(id)}>
              {label}
            </button>
          ))}
        </div>
      </div>
      {choice && <Shown key={`${period}/${choice.id}`} choice={choice} isDeep={isDeep} />}
      <div class="why-text">
        <p>
          <b>Why:</b> {capitalised(lesson.why)}
          {!lesson.why.includes(lesson.source) && <span class="source"> Source: {lesson.source}.</span>}
        </p>
      </div>
      {isDeep && <RunnersUp lesson={lesson} />}
    </section>
  );
}

function Shown({ choice, isDeep }: { choice: Choice; isDeep: boolean }): JSX.Element {
  const { shown, isTest } = choice;
  const { domain, legend } = useDrawing(shown.board);
  const frames = played(shown);
  const playback = usePlayback(frames.length - 1);
  const board = { ...shown.board, frames };
  const said = (step: number): string => playedText(shown.board, legend, shown, step);
  const isTall = (domain.height ?? 0) > 1.2 * (domain.width ?? 1);
  const calm = useCalm();
  useLayoutEffect(() => {
    if (!calm) playback.toggle();
  }, []);
  return (
    <div class={isTall ? 'shown tall' : 'shown'}>
      <Patterns surfaces={legend.surfaces} />
      <div class="shown-board">
        {board.map ? (
          <BoardDrawing
            domain={domain}
            legend={legend}
            board={board}
            step={playback.step}
            label={`${choice.label}: ${boardText(board, legend, board.start)}`}
            path
            closedAt={closedAt(shown)}
          />
        ) : (
          <ol class="steps">
            {frames.slice(1).map((_, i) => (
              <li>{said(i + 1)}</li>
            ))}
          </ol>
        )}
        {board.map && <Player playback={playback} what={choice.label} text={said(playback.step)} />}
      </div>
      <div class="shown-facts">
        {shown.gain !== undefined && !isTest && isDeep && (
          <p>
            <Explained term="gain">Gain</Explained> <b>{`${shown.gain.toFixed(2)}\u00d7`}</b>
          </p>
        )}
        <p class="list-title">{isTest ? 'It tests that' : 'It shows that'}</p>
        <ul class="sentences">
          {shown.sentences.map((sentence) => (
            <li>{sentence}</li>
          ))}
        </ul>
      </div>
    </div>
  );
}

function RunnersUp({ lesson }: { lesson: LessonNow }): JSX.Element | null {
  if (lesson.runners_up.length === 0) return null;
  const chosen = Math.max(...lesson.demonstrations.map(({ gain }) => gain ?? 0));
  const most = Math.max(chosen, ...lesson.runners_up.map(({ gain }) => gain));
  return (
    <div class="runners">
      <h4>
        <Explained term="runners_up">Runners-up</Explained> <span class="hint">{`gain, times; shown: ${chosen.toFixed(2)}\u00d7`}</span>
      </h4>
      <ol>
        {lesson.runners_up.slice(0, 5).map((runner) => (
          <Runner runner={runner} most={most} chosen={chosen} />
        ))}
      </ol>
    </div>
  );
}

function Runner({ runner, most, chosen }: { runner: RunnerUp; most: number; chosen: number }): JSX.Element {
  const { domain, legend } = useDrawing(runner.board);
  const board = { ...runner.board, frames: [runner.board.start] };
  const says = runner.sentences.join('; ');
  return (
    <li
      tabIndex={0}
      data-tip={`Gain ${runner.gain.toFixed(2)} (shown: ${chosen.toFixed(2)}). It would have shown that ${says || 'nothing new holds'}.`}
    >
      {board.map ? (
        <BoardDrawing domain={domain} legend={legend} board={board} step={0} label={`${worldText(runner.board)}, gain ${runner.gain.toFixed(2)}: ${says}`} />
      ) : (
        <span>{runner.board.start.state}</span>
      )}
      <span class="gain">
        <meter min={0} max={most} value={runner.gain} aria-hidden="true" />
        {`${runner.gain.toFixed(2)}\u00d7`}
      </span>
    </li>
  );
}
